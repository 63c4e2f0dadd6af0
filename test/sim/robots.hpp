// The robots of the simulation's tests, and the command with which they stand.
#pragma once

#include <random>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "model/robots.hpp"

namespace pmg {

using test::biped;
using test::z1;

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
