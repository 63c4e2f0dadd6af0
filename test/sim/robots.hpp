// The robots of the simulation's tests, and the command with which they stand.
#pragma once

#include <filesystem>
#include <random>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg {

inline const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(std::filesystem::path(PMG_SOURCE_DIR) / "config/robots/z1");
  return robot;
}

inline const model::RobotModel& biped() {
  static const model::RobotModel robot =
      model::load_robot(std::filesystem::path(PMG_SOURCE_DIR) / "test/data/robots/biped");
  return robot;
}

inline model::JointCommand standing_command(const model::RobotModel& robot) {
  const int n = robot.joint_index.size();
  model::JointCommand command;
  command.q = robot.q_stand();
  command.dq = JointVector::Zero(n);
  command.tau_ff = JointVector::Zero(n);
  command.kp.resize(n);
  command.kd.resize(n);
  for (int j = 0; j < n; ++j) {
    command.kp[j] = robot.joints[static_cast<std::size_t>(j)].kp_Nm_per_rad;
    command.kd[j] = robot.joints[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
  }
  return command;
}

inline double uniform(std::mt19937_64& random, double lower, double upper) {
  return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1p-53;
}

inline JointVector random_posture(const model::RobotModel& robot, std::mt19937_64& random) {
  JointVector q(robot.joint_index.size());
  for (int j = 0; j < q.size(); ++j) {
    const auto& joint = robot.joints[static_cast<std::size_t>(j)];
    q[j] = uniform(random, joint.lower_rad, joint.upper_rad);
  }
  return q;
}

}  // namespace pmg
