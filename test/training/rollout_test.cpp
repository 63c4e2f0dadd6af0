// The record of a robot that moves in the air, which training's physics is tested against, is what the controller's
// simulation does. Written anew with PMG_WRITE_RECORDS=1 when robot.yaml's joints, the URDF or the simulation change.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "folders.hpp"
#include "sim/motor_file.hpp"
#include "sim/world.hpp"

namespace pmg::test {
namespace {

using nlohmann::ordered_json;

constexpr int kTicks = 20, kStepsPerTick = 5;
constexpr double kTick_s = 0.01;
constexpr double kOtherEngine_rad = 1e-4;  // of the same equations in another version of MuJoCo

const std::string kRolloutRecord = pmg::test::project_folder() + "/test/data/training/rollout.json";

/// Soft as a policy's: by kind of leg joint.
const std::map<std::string, std::array<double, 2>> kGains = {{"hip_pitch", {120, 4.0}}, {"hip_roll", {120, 4.0}},
                                                             {"hip_yaw", {80, 3.0}},    {"knee", {150, 5.0}},
                                                             {"ankle_pitch", {120, 4}}, {"ankle_roll", {40, 2.0}}};

std::string kind_of(const std::string& joint) { return joint.substr(joint.find('_') + 1); }

/// Every joint swings away from the standing posture and back, each at its own pace, starting at rest.
JointVector target(const JointVector& stand, int tick) {
  JointVector q = stand;
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const double size_rad = 0.05 + 0.01 * static_cast<double>(j % 6),
                 frequency_Hz = 1.0 + 0.1 * static_cast<double>(j % 7);
    const double side = j % 2 == 0 ? 1.0 : -1.0;
    q[j] += side * size_rad * (1.0 - std::cos(2.0 * std::numbers::pi * frequency_Hz * (tick + 1) * kTick_s));
  }
  return q;
}

/// Training's upper body has no dry friction: there is none above the legs here.
JointVector friction_of_the_legs(const model::RobotModel& robot) {
  JointVector factor = JointVector::Zero(robot.joint_index.size());
  for (int j = 0; j < robot.joint_index.size(); ++j)
    factor[j] = robot.joints[static_cast<std::size_t>(j)].policy ? 1 : 0;
  return factor;
}

model::JointCommand command_of(const model::RobotModel& robot) {
  const JointVector zero = JointVector::Zero(robot.joint_index.size());
  model::JointCommand command{.q = zero, .dq = zero, .kp = zero, .kd = zero, .tau_ff = zero};
  for (int j = 0; j < robot.joint_index.size(); ++j) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
    command.kp[j] = joint.policy ? kGains.at(kind_of(joint.name))[0] : joint.kp_Nm_per_rad;
    command.kd[j] = joint.policy ? kGains.at(kind_of(joint.name))[1] : joint.kd_Nm_s_per_rad;
  }
  return command;
}

/// Drives that are late, slow and rub, on some joints of both legs; by the names of motor.yaml. Behind the play is a
/// whole leg: a light foot there has nothing to damp it, and where it knocks depends on the step (by 4 mrad between
/// training's and ours).
const std::map<std::string, std::map<std::string, double>> kMotors = {
    {"left_knee", {{"command.delay_s", 0.008}, {"friction.coulomb_Nm", 1.0}, {"friction.viscous_Nm_s_per_rad", 0.5}}},
    {"right_knee", {{"drive.kp_scale", 0.8}, {"friction.coulomb_Nm", 1.0}, {"friction.load_driving", 0.2}}},
    {"left_hip_pitch", {{"command.rate_limit_rad_s", 0.1}}},
    {"right_hip_roll", {{"transmission.armature_kg_m2", 0.2}, {"drive.limit", 2.0}}},
    {"right_hip_pitch",
     {{"transmission.armature_kg_m2", 0.04},
      {"transmission.stiffness_Nm_per_rad", 400.0},
      {"transmission.damping_Nm_s_per_rad", 0.8},
      {"transmission.backlash_rad", 0.03}}}};

sim::ActuatorsByJoint motors() {
  sim::ActuatorsByJoint motors;
  for (const auto& [joint, values] : kMotors) {
    for (const auto& [name, value] : values) model::actuator_parameter(name).in(motors[joint]) = value;
  }
  return motors;
}

ordered_json rollout(const model::RobotModel& robot, const sim::ActuatorsByJoint& motors) {
  sim::WorldOptions options;
  options.variation.joint_friction_factor = friction_of_the_legs(robot);
  options.motors = motors;
  sim::World world(robot, options);
  world.mj_data()->qpos[2] += 1.0;
  mj_step1(world.mj_model(), world.mj_data());
  model::JointCommand command = command_of(robot);
  ordered_json q = ordered_json::array();
  for (int tick = 0; tick < kTicks; ++tick) {
    command.q = target(robot.q_stand(), tick);
    for (int step = 0; step < kStepsPerTick; ++step) world.step(command);
    EXPECT_EQ(world.mj_data()->ncon, 0) << "tick " << tick;
    q.push_back(std::vector<double>(world.mj_data()->qpos + 7, world.mj_data()->qpos + world.mj_model()->nq));
  }
  return q;
}

ordered_json rollout_now(const model::RobotModel& robot) {
  ordered_json q_des = ordered_json::array();
  for (int tick = 0; tick < kTicks; ++tick) q_des.push_back(target(robot.q_stand(), tick));
  return {{"joints", robot.joint_index.names()},
          {"gains", kGains},
          {"motors", kMotors},
          {"q_des_rad", q_des},
          {"q_rad", rollout(robot, {})},
          {"q_with_motors_rad", rollout(robot, motors())}};
}

TEST(Rollout, InTheAirIsWhatTheRecordForTrainingSays) {
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const ordered_json now = rollout_now(robot);
  if (std::getenv("PMG_WRITE_RECORDS") != nullptr) std::ofstream(kRolloutRecord) << now.dump() << '\n';
  const auto record = ordered_json::parse(std::ifstream(kRolloutRecord));
  ASSERT_EQ(record["joints"], now["joints"]);
  ASSERT_EQ(record["gains"], now["gains"]);
  ASSERT_EQ(record["motors"], now["motors"]);
  for (const char* what : {"q_des_rad", "q_rad", "q_with_motors_rad"}) {
    ASSERT_EQ(record[what].size(), now[what].size());
    for (std::size_t tick = 0; tick < now[what].size(); ++tick) {
      for (std::size_t j = 0; j < now["joints"].size(); ++j) {
        EXPECT_NEAR(record[what][tick][j].get<double>(), now[what][tick][j].get<double>(), kOtherEngine_rad)
            << what << ", " << now["joints"][j] << ", tick " << tick;
      }
    }
  }
}

}  // namespace
}  // namespace pmg::test
