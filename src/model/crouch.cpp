#include "model/crouch.hpp"

#include <algorithm>
#include <cmath>
#include <kdl/frames.hpp>
#include <optional>

namespace pmg::model {

namespace {

constexpr double kMargin_rad = 0.0349066;  // 2 degrees
constexpr double kMoves_rad = 1e-3;
constexpr double kFarthest = 10.0;  // times the squat's way: beyond every limit
constexpr int kHalvings = 50;

/// The robot's first moment of mass about the base [kg m], and the left foot's pose.
struct Bodies {
  KDL::Vector moment = KDL::Vector::Zero();
  KDL::Frame foot;
};

void add(const RobotModel& robot, const JointVector& q, const KDL::SegmentMap::const_iterator& element,
         const KDL::Frame& parent, Bodies& bodies) {
  for (const KDL::SegmentMap::const_iterator& child : GetTreeElementChildren(element->second)) {
    const KDL::Segment& segment = GetTreeElementSegment(child->second);
    const KDL::Joint& joint = segment.getJoint();
    const bool moves = joint.getType() != KDL::Joint::Fixed;
    const KDL::Frame pose = parent * segment.pose(moves ? q[robot.joint_index.at(joint.getName())] : 0.0);
    const KDL::RigidBodyInertia& inertia = segment.getInertia();
    bodies.moment += inertia.getMass() * (pose * inertia.getCOG());
    if (segment.getName() == robot.feet[kLeft].link) bodies.foot = pose;
    add(robot, q, child, pose, bodies);
  }
}

/// Of the centre of mass before its place over the sole, in the foot's frame [m].
double ahead_of_place_m(const RobotModel& robot, const JointVector& q, double ahead_share) {
  Bodies bodies;
  bodies.moment = robot.base_inertia.getMass() * robot.base_inertia.getCOG();
  add(robot, q, robot.tree.getRootSegment(), KDL::Frame::Identity(), bodies);
  const KDL::Vector com_F = bodies.foot.Inverse() * (bodies.moment / robot.total_mass_kg);
  const FootModel& sole = robot.feet[kLeft];
  return com_F.x() - (sole.box_center_F.x() + ahead_share * sole.box_half_size_m.x());
}

}  // namespace

JointVector deepest_crouch(const RobotModel& robot, const JointVector& squat, double ahead_share) {
  const JointVector stand = robot.q_stand();
  const JointVector lower = robot.q_lower().array() + kMargin_rad, upper = robot.q_upper().array() - kMargin_rad;
  const auto moves = [&](int joint) { return std::abs(squat[joint] - stand[joint]) > kMoves_rad; };
  // What the squat does not move, and the legs don't, has a posture of its own.
  const JointVector own = robot.q_sit_down();
  JointVector crouch = squat;
  for (Eigen::Index joint = 0; joint < crouch.size(); ++joint) {
    if (own[joint] != stand[joint]) crouch[joint] = own[joint];
  }
  PerFoot<std::optional<int>> hip;
  for (const Foot foot : {kLeft, kRight}) {
    for (const int joint : robot.leg_joints[foot]) {
      if (!moves(joint)) continue;
      if (!hip[foot]) hip[foot] = joint;
      crouch[joint] = std::clamp(stand[joint] + kFarthest * (squat[joint] - stand[joint]), lower[joint], upper[joint]);
    }
  }
  if (!hip[kLeft] || !hip[kRight]) return squat;
  const auto ahead_m = [&](double share) {
    for (const Foot foot : {kLeft, kRight}) {
      const int joint = *hip[foot];
      crouch[joint] = lower[joint] + share * (upper[joint] - lower[joint]);
    }
    return ahead_of_place_m(robot, crouch, ahead_share);
  };
  double low = 0.0, high = 1.0;
  const bool falls = ahead_m(low) > 0.0;
  if (falls == (ahead_m(high) > 0.0)) return squat;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    ((ahead_m(middle) > 0.0) == falls ? low : high) = middle;
  }
  return crouch;
}

}  // namespace pmg::model
