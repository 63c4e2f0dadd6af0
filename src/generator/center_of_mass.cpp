#include "generator/center_of_mass.hpp"

namespace pmg::generator {
namespace {

/// Adds mass * position and mass of this segment and of all segments beyond it. parent: pose of the parent segment in
/// the base frame.
void add(const model::RobotModel& robot, const JointVector& q, const KDL::SegmentMap::const_iterator& element,
         const KDL::Frame& parent, KDL::Vector& moment, double& mass) {
  const KDL::Segment& segment = element->second.segment;
  const std::optional<int> joint = robot.joint_index.find(segment.getJoint().getName());
  const KDL::Frame frame = parent * segment.pose(joint ? q[*joint] : 0.0);
  const KDL::RigidBodyInertia& inertia = segment.getInertia();
  moment += inertia.getMass() * (frame * inertia.getCOG());
  mass += inertia.getMass();
  for (const KDL::SegmentMap::const_iterator& child : element->second.children) {
    add(robot, q, child, frame, moment, mass);
  }
}

}  // namespace

Eigen::Vector3d center_of_mass(const model::RobotModel& robot, const JointVector& q) {
  double mass = robot.base_inertia.getMass();
  KDL::Vector moment = mass * robot.base_inertia.getCOG();
  for (const KDL::SegmentMap::const_iterator& child : robot.tree.getRootSegment()->second.children) {
    add(robot, q, child, KDL::Frame::Identity(), moment, mass);
  }
  return Eigen::Vector3d(moment.x(), moment.y(), moment.z()) / mass;
}

}  // namespace pmg::generator
