#include "control/drive_gains.hpp"

#include <fmt/format.h>

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
