#include "retargeting/arm_points.hpp"

#include <string>

#include "model/link_chain.hpp"

namespace pmg::retargeting {
namespace {

/// The last link below a joint, along first children.
std::string last_link_below(const model::RobotModel& robot, int joint) {
  urdf::LinkConstSharedPtr link =
      robot.urdf->getLink(robot.urdf->getJoint(robot.joint_index.name(joint))->child_link_name);
  while (!link->child_links.empty()) link = link->child_links.front();
  return link->name;
}

}  // namespace

std::optional<ArmChain> ArmChain::of(const model::RobotModel& robot, const generator::JointRoles& roles, Foot side) {
  if (!roles.shoulder_pitch[side] || !roles.elbow[side]) return std::nullopt;
  ArmChain arm(model::chain_between(robot, robot.base_link, last_link_below(robot, *roles.elbow[side])));
  for (std::size_t i = 0; i < arm.chain_.size(); ++i) {
    if (arm.chain_.joint(i) == *roles.shoulder_pitch[side]) arm.shoulder_ = i;
    if (arm.chain_.joint(i) == *roles.elbow[side]) arm.elbow_ = i;
  }
  return arm;
}

ArmPoints ArmChain::compute(const JointVector& q) {
  chain_.compute(q);
  return {chain_.origin(shoulder_), chain_.origin(elbow_), chain_.p()};
}

std::vector<int> ArmChain::joints() const {
  std::vector<int> list;
  for (std::size_t i = shoulder_; i <= elbow_; ++i) list.push_back(chain_.joint(i));
  return list;
}

}  // namespace pmg::retargeting
