#include "retargeting/upper_body_imitation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pmg::retargeting {
namespace {

double arm_pitch(const SidePose& pose) { return std::atan2(pose.upper_arm.x(), -pose.upper_arm.z()); }
double elbow_flexion(const SidePose& pose) {
  return std::atan2(pose.upper_arm.cross(pose.forearm).norm(), pose.upper_arm.dot(pose.forearm));
}

template <typename Angle>
double deviation(const HumanCycle& cycle, std::size_t sample, Angle angle) {
  double mean = 0.0;
  for (const HumanPose& pose : cycle.pose) mean += angle(pose) / static_cast<double>(cycle.pose.size());
  return angle(cycle.pose[sample]) - mean;
}

}  // namespace

void imitate_upper_body(const model::RobotModel& robot, const generator::JointRoles& roles, const HumanCycle& cycle,
                        std::size_t sample, double pelvis_roll_rad, double margin_rad, JointVector& q) {
  const auto turn = [&](int joint, double by_rad) {
    const model::Joint& limits = robot.joints[static_cast<std::size_t>(joint)];
    q[joint] = std::clamp(q[joint] + by_rad, limits.lower_rad + margin_rad, limits.upper_rad - margin_rad);
  };
  if (cycle.pose[sample].arms_known) {
    for (const Foot foot : {kLeft, kRight}) {
      if (roles.shoulder_pitch[foot]) {
        turn(*roles.shoulder_pitch[foot],
             -deviation(cycle, sample, [&](const HumanPose& pose) { return arm_pitch(pose.side[foot]); }));
      }
      if (roles.elbow[foot]) {
        turn(*roles.elbow[foot],
             -deviation(cycle, sample, [&](const HumanPose& pose) { return elbow_flexion(pose.side[foot]); }));
      }
    }
  }
  const double yaw = deviation(cycle, sample, [](const HumanPose& pose) { return pose.shoulder_yaw_rad; });
  if (roles.waist_yaw && roles.waist_roll && roles.waist_pitch) {
    // R_BT = Rx(-roll) Rz(yaw) = Rz(a) Rx(b) Ry(c), as in generator::move_upper_body.
    const Eigen::Matrix3d R_BT = (Eigen::AngleAxisd(-pelvis_roll_rad, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
                                     .toRotationMatrix();
    turn(*roles.waist_yaw, std::atan2(-R_BT(0, 1), R_BT(1, 1)));
    turn(*roles.waist_roll, std::asin(R_BT(2, 1)));
    turn(*roles.waist_pitch, std::atan2(-R_BT(2, 0), R_BT(2, 2)));
  }
  if (roles.head_yaw) turn(*roles.head_yaw, -yaw);
}

}  // namespace pmg::retargeting
