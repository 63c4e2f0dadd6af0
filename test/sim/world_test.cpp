#include "sim/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "robots.hpp"

namespace pmg {
namespace {

/// Commands for every term of the drives: targets around the standing posture, all gains, feed-forward.
model::JointCommand random_command(const model::RobotModel& robot, std::mt19937_64& random) {
  model::JointCommand command = standing_command(robot);
  for (int j = 0; j < command.q.size(); ++j) {
    command.q[j] += uniform(random, -0.4, 0.4);
    command.dq[j] = uniform(random, -2.0, 2.0);
    command.kp[j] *= uniform(random, 0.0, 2.0);
    command.kd[j] *= uniform(random, 0.2, 1.5);
    command.tau_ff[j] = uniform(random, -10.0, 10.0);
  }
  return command;
}

bool same_bytes(const model::RobotState& a, const model::RobotState& b) {
  const auto same = [](const auto& x, const auto& y) {
    return std::memcmp(x.data(), y.data(), static_cast<std::size_t>(x.size()) * sizeof(double)) == 0;
  };
  return a.stamp_ns == b.stamp_ns && a.bus_sample == b.bus_sample && same(a.q, b.q) && same(a.dq, b.dq) &&
         same(a.tau, b.tau) && same(a.gyro_rad_s, b.gyro_rad_s) && same(a.acceleration_m_s2, b.acceleration_m_s2) &&
         same(a.orientation_WI.coeffs(), b.orientation_WI.coeffs());
}

TEST(World, SameCommandsGiveTheSameBytes) {
  sim::WorldOptions options;
  options.seed = 7;
  options.gyro_noise_rad_s = options.encoder_noise_rad = options.orientation_noise_rad = 0.01;
  sim::World a(z1(), options), b(z1(), options);
  std::mt19937_64 random(11);
  model::RobotState state_a, state_b;
  for (int i = 0; i < 1000; ++i) {
    const model::JointCommand command = random_command(z1(), random);
    a.step(command);
    b.step(command);
    a.read(state_a);
    b.read(state_b);
    ASSERT_TRUE(same_bytes(state_a, state_b)) << "at step " << i;
  }
}

TEST(World, ResetGivesTheSameBytesAgain) {
  sim::WorldOptions options;
  options.encoder_noise_rad = 0.01;
  sim::World world(z1(), options);
  const auto last_state = [&world] {
    std::mt19937_64 random(5);
    model::RobotState state;
    for (int i = 0; i < 300; ++i) world.step(random_command(z1(), random));
    world.read(state);
    return state;
  };
  const model::RobotState first = last_state();
  world.set_push({5, 0, 0});
  world.set_hoist(0.2, 1.0);
  world.reset();
  EXPECT_TRUE(same_bytes(first, last_state()));
}

TEST(World, StandsUnderItsOwnGainsForTenSeconds) {
  for (const model::RobotModel* robot : {&z1(), &biped()}) {
    sim::World world(*robot, {});
    const model::JointCommand command = standing_command(*robot);
    const Eigen::Vector3d start = world.truth().p_WB;
    for (int i = 0; i < 5000; ++i) world.step(command);
    EXPECT_FALSE(world.diverged());
    EXPECT_LT((world.truth().p_WB - start).norm(), 0.03) << robot->name << " at " << world.truth().p_WB.transpose();
    EXPECT_LT(world.truth().v_WB_W.norm(), 0.01) << robot->name;
  }
}

TEST(World, TheFloorCarriesTheWeightOfAStandingRobot) {
  sim::World world(z1(), {});
  for (int i = 0; i < 2500; ++i) world.step(standing_command(z1()));
  const model::GroundTruth truth = world.truth();
  const double weight_N = z1().total_mass_kg * 9.81;
  EXPECT_NEAR(truth.foot_force_N[kLeft] + truth.foot_force_N[kRight], weight_N, 0.02 * weight_N);  // still settling
  EXPECT_NEAR(truth.foot_force_N[kLeft], truth.foot_force_N[kRight], 0.05 * weight_N);
  EXPECT_LT(truth.foot_slip_m_s[kLeft], 1e-3);
}

TEST(World, SlipIsTheSpeedOfTheSoleThatTouches) {
  sim::World world(z1(), {});
  const model::JointCommand command = standing_command(z1());
  for (int i = 0; i < 500; ++i) world.step(command);
  mju_zero(world.mj_data()->qvel, world.mj_model()->nv);
  world.mj_data()->qvel[0] = 0.3;
  world.mj_data()->qvel[1] = -0.4;
  mj_forward(world.mj_model(), world.mj_data());
  world.step(command);
  EXPECT_NEAR(world.truth().foot_slip_m_s[kLeft], 0.5, 1e-9);
  EXPECT_NEAR(world.truth().foot_slip_m_s[kRight], 0.5, 1e-9);
}

TEST(World, DriveLawIsHeldToRoundingAndClippedAtEffort) {
  sim::WorldOptions options;
  options.gantry = true;
  sim::World world(z1(), options);
  std::mt19937_64 random(3);
  model::RobotState before, after;
  int clipped = 0, free = 0;
  for (int i = 0; i < 400; ++i) {
    model::JointCommand command = random_command(z1(), random);
    if (i % 4 == 0) command.kp.setZero();  // a drive that only damps
    world.read(before);
    world.step(command);
    world.read(after);
    for (int j = 0; j < command.q.size(); ++j) {
      const double limit = z1().joints[static_cast<std::size_t>(j)].effort_limit_Nm;
      const double torque = command.kp[j] * (command.q[j] - before.q[j]) +
                            command.kd[j] * (command.dq[j] - before.dq[j]) + command.tau_ff[j];
      ASSERT_NEAR(after.tau[j], std::clamp(torque, -limit, limit), 1e-9) << z1().joint_index.name(j);
      (std::abs(torque) > limit ? clipped : free) += 1;
    }
  }
  EXPECT_GT(clipped, 100);
  EXPECT_GT(free, 100);
}

TEST(World, StepIsMuJoCosStep) {
  sim::World world(z1(), {});
  model::JointCommand command = standing_command(z1());
  command.q[z1().joint_index.at("left_elbow")] -= 0.5;
  world.step(command);
  mjModel* model = mj_copyModel(nullptr, world.mj_model());
  mjData* data = mj_copyData(nullptr, model, world.mj_data());
  for (int i = 0; i < 500; ++i) {
    world.step(command);
    mju_copy(data->ctrl, world.mj_data()->ctrl, model->nu);  // the actuator models' torque, and its slope in speed
    mju_copy(model->actuator_biasprm, world.mj_model()->actuator_biasprm, mjNBIAS * model->nu);
    mj_step(model, data);
  }
  // The solver starts from other estimates, so contacts agree only to its tolerance.
  for (int i = 0; i < model->nq; ++i) EXPECT_NEAR(world.mj_data()->qpos[i], data->qpos[i], 1e-6) << i;
  mj_deleteData(data);
  mj_deleteModel(model);
}

TEST(World, CommandActsInTheNextSampleAndSamplesCount) {
  sim::World world(z1(), {});
  model::RobotState state;
  world.read(state);
  EXPECT_EQ(state.bus_sample, 0U);
  EXPECT_EQ(state.stamp_ns, 0);
  world.step(standing_command(z1()));
  world.read(state);
  EXPECT_EQ(state.bus_sample, 1U);
  EXPECT_EQ(state.stamp_ns, 2'000'000);
  EXPECT_DOUBLE_EQ(world.time_s(), 0.002);
}

TEST(World, StampsDontDrift) {
  sim::World world(biped(), {});
  const model::JointCommand command = standing_command(biped());
  model::RobotState state;
  for (int i = 0; i < 30000; ++i) world.step(command);
  world.read(state);
  EXPECT_EQ(state.stamp_ns, 60'000'000'000);
}

TEST(World, NanInACommandIsReportedAsDivergence) {
  sim::World world(z1(), {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto breaks = [&world](auto&& damage) {
    world.reset();
    model::JointCommand command = standing_command(z1());
    world.step(command);
    EXPECT_FALSE(world.diverged());
    damage(command);
    for (int i = 0; i < 3; ++i) world.step(command);  // a bad force shows in the next state
    return world.diverged();
  };
  EXPECT_TRUE(breaks([nan](model::JointCommand& c) { c.q[3] = nan; }));
  EXPECT_TRUE(breaks([nan](model::JointCommand& c) { c.kp[3] = nan; }));
  EXPECT_TRUE(breaks([nan](model::JointCommand& c) { c.kd[3] = nan; }));
  EXPECT_FALSE(breaks([](model::JointCommand&) {}));
}

TEST(World, AStateThatBlowsUpIsReportedAndFrozen) {
  sim::World world(z1(), {});
  const model::JointCommand command = standing_command(z1());
  world.step(command);
  world.mj_data()->qvel[8] = 1e12;
  for (int i = 0; i < 3; ++i) world.step(command);
  EXPECT_TRUE(world.diverged());
  const double stopped_s = world.time_s();
  world.step(command);
  EXPECT_EQ(world.time_s(), stopped_s);
  world.reset();
  EXPECT_FALSE(world.diverged());
}

TEST(World, PushMovesTheRobotItsWay) {
  sim::World world(z1(), {});
  const model::JointCommand command = standing_command(z1());
  for (int i = 0; i < 2500; ++i) world.step(command);  // settled
  const Eigen::Vector3d before = world.truth().p_WB;
  world.set_push({0.0, 15.0, 0.0});
  for (int i = 0; i < 250; ++i) world.step(command);
  EXPECT_GT(world.truth().p_WB.y() - before.y(), 0.003);
  EXPECT_NEAR(world.truth().p_WB.x(), before.x(), 0.002);
}

}  // namespace
}  // namespace pmg
