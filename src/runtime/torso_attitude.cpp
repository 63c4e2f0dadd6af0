#include "runtime/torso_attitude.hpp"

#include <cmath>
#include <stdexcept>

namespace pmg::runtime {

namespace {

model::ChainKinematics chain_between(const model::RobotModel& robot, const std::string& from, const std::string& to) {
  KDL::Chain chain;
  if (!robot.tree.getChain(from, to, chain)) {
    throw std::invalid_argument(robot.name + ": no chain of joints leads from " + from + " to " + to);
  }
  std::vector<int> joints;
  for (const KDL::Segment& segment : chain.segments) {
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() != KDL::Joint::Fixed) joints.push_back(robot.joint_index.at(joint.getName()));
  }
  return {chain, std::move(joints)};
}

}  // namespace

TorsoAttitude::TorsoAttitude(const model::RobotModel& robot)
    : imu_link_to_torso_(chain_between(robot, robot.imu.link, robot.torso_link)), R_LI_(robot.imu.T_LI.linear()) {}

double TorsoAttitude::error_rad(const model::RobotState& state, const RollPitchAim& aim) noexcept {
  imu_link_to_torso_.compute(state.q);
  const Eigen::Vector3d up_I = state.orientation_WI.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_T = imu_link_to_torso_.R().transpose() * (R_LI_ * up_I);
  // Of (Ry(pitch) Rx(roll))^T z.
  const Eigen::Vector3d aimed_T(-std::sin(aim.pitch_rad), std::cos(aim.pitch_rad) * std::sin(aim.roll_rad),
                                std::cos(aim.pitch_rad) * std::cos(aim.roll_rad));
  return std::atan2(up_T.cross(aimed_T).norm(), up_T.dot(aimed_T));
}

}  // namespace pmg::runtime
