#include "model/link_chain.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

namespace pmg::model {

ChainKinematics chain_between(const RobotModel& robot, const std::string& from, const std::string& to) {
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

}  // namespace pmg::model
