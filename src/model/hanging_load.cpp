#include "model/hanging_load.hpp"

#include <algorithm>
#include <cmath>
#include <kdl/frames.hpp>
#include <kdl/rigidbodyinertia.hpp>
#include <numbers>
#include <stdexcept>

namespace pmg::model {

namespace {

double angle(const RobotModel& robot, const JointVector& q, const KDL::Segment& segment) {
  const auto index = robot.joint_index.find(segment.getJoint().getName());
  return index ? q[*index] : 0.0;
}

/// (link) => its pose in the base.
KDL::Frame pose(const RobotModel& robot, const JointVector& q, KDL::SegmentMap::const_iterator link) {
  if (link == robot.tree.getRootSegment()) return KDL::Frame::Identity();
  const KDL::Segment& segment = GetTreeElementSegment(link->second);
  return pose(robot, q, GetTreeElementParent(link->second)) * segment.pose(angle(robot, q, segment));
}

/// (link) => inertia of this link and all beyond it as one body, in this link's frame.
KDL::RigidBodyInertia inertia_from(const RobotModel& robot, const JointVector& q,
                                   KDL::SegmentMap::const_iterator link) {
  KDL::RigidBodyInertia sum = GetTreeElementSegment(link->second).getInertia();
  for (const KDL::SegmentMap::const_iterator& child : GetTreeElementChildren(link->second)) {
    const KDL::Segment& segment = GetTreeElementSegment(child->second);
    sum = sum + segment.pose(angle(robot, q, segment)) * inertia_from(robot, q, child);
  }
  return sum;
}

KDL::SegmentMap::const_iterator link_moved_by(const RobotModel& robot, const std::string& joint) {
  const KDL::SegmentMap& links = robot.tree.getSegments();
  const auto found = std::find_if(links.begin(), links.end(), [&](const auto& link) {
    return robot.joint_index.find(joint) && GetTreeElementSegment(link.second).getJoint().getName() == joint;
  });
  if (found == links.end()) throw std::invalid_argument(joint + " isn't a joint of " + robot.name);
  return found;
}

}  // namespace

HangingLoad hanging_load(const RobotModel& robot, const std::string& joint) {
  return hanging_load(robot, joint, robot.q_stand());
}

HangingLoad hanging_load(const RobotModel& robot, const std::string& joint, const JointVector& q) {
  const auto link = link_moved_by(robot, joint);
  const KDL::Segment& segment = GetTreeElementSegment(link->second);
  const KDL::Frame parent = pose(robot, q, GetTreeElementParent(link->second));
  const KDL::Vector axis = parent.M * segment.getJoint().JointAxis(),
                    origin = parent * segment.getJoint().JointOrigin();
  const KDL::RigidBodyInertia beyond = inertia_from(robot, q, link);
  const auto body_at = [&](double q_rad) { return parent * segment.pose(q_rad) * beyond; };  // in the base's axes

  HangingLoad load;
  load.mass_kg = beyond.getMass();
  const KDL::RigidBodyInertia about_origin = body_at(0.0).RefPoint(origin);
  load.inertia_kg_m2 = KDL::dot(axis, about_origin.getRotationalInertia() * axis);
  // The torque that holds the joint against gravity is gravity_Nm sin(q - hangs_at).
  const auto holding_Nm = [&](double q_rad) {
    const KDL::Vector weight_N(0.0, 0.0, -load.mass_kg * kGravity_m_s2);
    return -KDL::dot(axis, (body_at(q_rad).getCOG() - origin) * weight_N);
  };
  const double at_zero_Nm = holding_Nm(0.0), at_right_angle_Nm = holding_Nm(0.5 * std::numbers::pi);
  load.gravity_Nm = std::hypot(at_zero_Nm, at_right_angle_Nm);
  load.hangs_at_rad = std::atan2(-at_zero_Nm, at_right_angle_Nm);
  const KDL::Vector center = body_at(angle(robot, q, segment)).getCOG(), moves = axis * (center - origin);
  load.center_m = {center.x(), center.y(), center.z()};
  load.center_m_per_rad = {moves.x(), moves.y(), moves.z()};
  return load;
}

}  // namespace pmg::model
