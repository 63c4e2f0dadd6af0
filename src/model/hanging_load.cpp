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

/// (holding torque at 0 and at a right angle) => the sine of the angle that it is.
GravityLoad from_two(double at_zero_Nm, double at_right_angle_Nm) {
  return {.gravity_Nm = std::hypot(at_zero_Nm, at_right_angle_Nm),
          .hangs_at_rad = std::atan2(-at_zero_Nm, at_right_angle_Nm)};
}

}  // namespace

double GravityLoad::holding_Nm(double q_rad) const noexcept { return gravity_Nm * std::sin(q_rad - hangs_at_rad); }

bool beyond(const RobotModel& robot, const std::string& joint, const std::string& link) {
  for (auto at = robot.tree.getSegment(link); at != robot.tree.getSegments().end() && at != robot.tree.getRootSegment();
       at = GetTreeElementParent(at->second)) {
    if (GetTreeElementSegment(at->second).getJoint().getName() == joint) return true;
  }
  return false;
}

bool turns_base(const RobotModel& robot, const std::string& joint, const Hanging& hanging) {
  return !hanging.held_link.empty() && beyond(robot, joint, hanging.held_link);
}

GravityLoad gravity_load(const RobotModel& robot, const std::string& joint, const JointVector& q,
                         const Hanging& hanging) {
  const auto link = link_moved_by(robot, joint);
  const KDL::Segment& segment = GetTreeElementSegment(link->second);
  const KDL::Frame parent = pose(robot, q, GetTreeElementParent(link->second));
  const KDL::Frame child = parent * segment.pose(angle(robot, q, segment));
  const KDL::RigidBodyInertia beyond = child * inertia_from(robot, q, link);  // in the base's axes
  const KDL::Vector down(hanging.down_B.x(), hanging.down_B.y(), hanging.down_B.z());
  const KDL::Vector axis = parent.M * segment.getJoint().JointAxis(),
                    origin = parent * segment.getJoint().JointOrigin();
  double mass_kg = beyond.getMass(), sign = 1.0;
  KDL::Vector center = beyond.getCOG();
  if (turns_base(robot, joint, hanging)) {
    const KDL::RigidBodyInertia all = inertia_from(robot, q, robot.tree.getRootSegment());
    center = (all.getMass() * all.getCOG() - mass_kg * center) / (all.getMass() - mass_kg);
    mass_kg = all.getMass() - mass_kg;
    sign = -1.0;  // gravity stands still in the held link's axes, and in the base's while the limb moves
  }
  // Turned about the axis by as much as the joint is away from where it is.
  const double now_rad = angle(robot, q, segment);
  const auto holding_Nm = [&](double q_rad) {
    const KDL::Vector arm = KDL::Rotation::Rot(axis, sign * (q_rad - now_rad)) * (center - origin);
    return -sign * mass_kg * kGravity_m_s2 * KDL::dot(down, axis * arm);
  };
  return from_two(holding_Nm(0.0), holding_Nm(0.5 * std::numbers::pi));
}

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
  const GravityLoad gravity = gravity_load(robot, joint, q, {});
  load.gravity_Nm = gravity.gravity_Nm;
  load.hangs_at_rad = gravity.hangs_at_rad;
  const KDL::Vector center = body_at(angle(robot, q, segment)).getCOG(), moves = axis * (center - origin);
  load.axis = {axis.x(), axis.y(), axis.z()};
  load.center_m = {center.x(), center.y(), center.z()};
  load.center_m_per_rad = {moves.x(), moves.y(), moves.z()};
  return load;
}

}  // namespace pmg::model
