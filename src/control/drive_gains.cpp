#include "control/drive_gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pmg::control {

policy::DriveGains own_gains(const model::RobotModel& robot) {
  const Eigen::Index n = robot.joint_index.size();
  policy::DriveGains gains{JointVector(n), JointVector(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    gains.kp_Nm_per_rad[i] = robot.joints[static_cast<std::size_t>(i)].kp_Nm_per_rad;
    gains.kd_Nm_s_per_rad[i] = robot.joints[static_cast<std::size_t>(i)].kd_Nm_s_per_rad;
  }
  return gains;
}

policy::DriveGains gains_in_force(const model::RobotModel& robot, const policy::Policy& policy,
                                  const hal::GuardOptions& guard) {
  const auto told = policy.gains();
  const policy::DriveGains gains = told ? *told : own_gains(robot);
  for (Eigen::Index i = 0; told && i < std::min(gains.kp_Nm_per_rad.size(), gains.kd_Nm_s_per_rad.size()); ++i) {
    if (!(gains.kp_Nm_per_rad[i] > 0.0) || gains.kd_Nm_s_per_rad[i] > 0.0) continue;
    throw std::invalid_argument(
        fmt::format("the policy's kd of joint {} is {:g} Nm s/rad beside a kp of {:g} Nm/rad: "
                    "the joint would swing undamped; expected more than 0",
                    i < robot.joint_index.size() ? robot.joint_index.name(static_cast<int>(i)) : "?",
                    gains.kd_Nm_s_per_rad[i], gains.kp_Nm_per_rad[i]));
  }
  const auto plausible = [&](const JointVector& values, double largest) {
    return values.size() == robot.joint_index.size() && (values.array() >= 0.0).all() &&
           (values.array() <= largest).all();
  };
  if (!plausible(gains.kp_Nm_per_rad, guard.max_kp_Nm_per_rad) ||
      !plausible(gains.kd_Nm_s_per_rad, guard.max_kd_Nm_s_per_rad)) {
    throw std::invalid_argument(fmt::format(
        "{} drive gains don't fit the robot; expected one of each for {} joints, kp from 0 to {:g} Nm/rad and kd from "
        "0 to {:g} Nm s/rad, the most that the bus guard lets pass",
        told ? "the policy's" : "robot.yaml's", robot.joint_index.size(), guard.max_kp_Nm_per_rad,
        guard.max_kd_Nm_s_per_rad));
  }
  return gains;
}

}  // namespace pmg::control
