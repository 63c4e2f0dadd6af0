#include "model/sole_load.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pmg/types.hpp"

namespace pmg::model {

namespace {

/// Singular values below this share of the Jacobian's largest count as zero: such motions move no foot.
constexpr double kRank = 1e-3;
/// If more than this share of a unit of virtual lift is missing, the torques don't determine the vertical force. A
/// spread leg of five joints loses a little, because its foot turns.
constexpr double kLiftMiss = 0.2;

}  // namespace

SoleLoads::SoleLoads(const RobotModel& robot)
    : legs_{leg(robot, kLeft), leg(robot, kRight)}, still_(JointVector::Zero(robot.joint_index.size())) {
  set_posture(robot.q_stand(), gravity_B_);
}

SoleLoads::Leg SoleLoads::leg(const RobotModel& robot, Foot side) {
  const std::vector<int>& joints = robot.leg_joints[side];
  const FootModel& foot = robot.feet[side];
  const auto n = static_cast<Eigen::Index>(joints.size());
  Leg leg{.chain = robot.leg_chain[side],
          .joints = joints,
          .dry_friction_Nm = LegVector::Zero(n),
          .armature_kg_m2 = LegVector::Zero(n),
          .sole_center_F = foot.box_center_F - Eigen::Vector3d(0.0, 0.0, foot.box_half_size_m.z()),
          .half_sole_m = foot.box_half_size_m.head<2>(),
          .own_Nm = LegVector::Zero(n),
          .lift_rad_m = LegVector::Zero(n),
          .inertia_kg_m2 = LegVector::Zero(n),
          .J_inverse = {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(i)])];
    leg.dry_friction_Nm[i] = joint.friction_Nm;
    leg.armature_kg_m2[i] = joint.armature_kg_m2;
  }
  return leg;
}

void SoleLoads::set_posture(const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept {
  set_motion({.q = q,
              .dq = still_,
              .ddq = still_,
              .gravity_B = gravity_B,
              .specific_force_B = -kGravity_m_s2 * gravity_B,
              .omega_B = Eigen::Vector3d::Zero(),
              .alpha_B = Eigen::Vector3d::Zero()});
}

void SoleLoads::set_motion(const LegMotion& motion) noexcept {
  gravity_B_ = motion.gravity_B;
  for (Leg& leg : legs_) compute(leg, motion);
}

void SoleLoads::compute(Leg& leg, const LegMotion& motion) noexcept {
  const std::size_t n = leg.joints.size();
  // Of each moving joint: its axis, a point on it, and of the links up to the next joint mass, first moment, and the
  // force and the moment about the base's origin that hold and move them (Newton-Euler).
  std::array<Eigen::Vector3d, kMaxLegJoints> axis, origin, moment_kg_m, force_N, moment_Nm;
  std::array<double, kMaxLegJoints> mass_kg{};
  for (auto* each : {&moment_kg_m, &force_N, &moment_Nm}) each->fill(Eigen::Vector3d::Zero());
  KDL::Frame pose = KDL::Frame::Identity();
  Eigen::Vector3d omega = motion.omega_B, alpha = motion.alpha_B;
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), specific_force = motion.specific_force_B;  // of the last joint
  const auto relative = [&](const Eigen::Vector3d& r) -> Eigen::Vector3d {
    return alpha.cross(r) + omega.cross(omega.cross(r));
  };
  std::size_t moving = 0;
  for (const KDL::Segment& segment : leg.chain.segments) {
    const KDL::Joint& joint = segment.getJoint();
    double angle_rad = 0.0;
    if (joint.getType() != KDL::Joint::Fixed) {
      const int at = leg.joints[moving];
      axis[moving] = to_eigen(pose.M * joint.JointAxis());
      origin[moving] = to_eigen(pose * joint.JointOrigin());
      angle_rad = motion.q[at];
      specific_force += relative(origin[moving] - point);
      point = origin[moving];
      alpha += axis[moving] * motion.ddq[at] + omega.cross(axis[moving] * motion.dq[at]);
      omega += axis[moving] * motion.dq[at];
      ++moving;
    }
    pose = pose * segment.pose(angle_rad);
    const KDL::RigidBodyInertia& link = segment.getInertia();
    if (moving == 0) continue;  // fixed to the base
    const double mass = link.getMass();
    const Eigen::Vector3d center = to_eigen(pose * link.getCOG());
    const Eigen::Vector3d force = mass * (specific_force + relative(center - point));
    const KDL::RotationalInertia about_center =
        (pose.M * KDL::RigidBodyInertia(link).RefPoint(link.getCOG())).getRotationalInertia();
    const Eigen::Matrix3d inertia = Eigen::Map<const Eigen::Matrix3d>(about_center.data);  // symmetric
    mass_kg[moving - 1] += mass;
    moment_kg_m[moving - 1] += mass * center;
    force_N[moving - 1] += force;
    moment_Nm[moving - 1] += center.cross(force) + inertia * alpha + omega.cross(inertia * omega);
  }
  leg.R_BF = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.M.data);
  const Eigen::Vector3d p_BF = to_eigen(pose.p);

  LegJacobian J(6, static_cast<Eigen::Index>(n));
  double below_kg = 0.0;
  Eigen::Vector3d below_kg_m = Eigen::Vector3d::Zero(), below_N = below_kg_m, below_Nm = below_kg_m;
  for (std::size_t i = n; i-- > 0;) {
    const auto column = static_cast<Eigen::Index>(i);
    below_kg += mass_kg[i];
    below_kg_m += moment_kg_m[i];
    below_N += force_N[i];
    below_Nm += moment_Nm[i];
    leg.own_Nm[column] =
        axis[i].dot(below_Nm - origin[i].cross(below_N)) + leg.armature_kg_m2[column] * motion.ddq[leg.joints[i]];
    const Eigen::Vector3d arm_kg_m = below_kg_m - below_kg * origin[i];
    leg.inertia_kg_m2[column] =
        leg.armature_kg_m2[column] + (below_kg > 0.0 ? axis[i].cross(arm_kg_m).squaredNorm() / below_kg : 0.0);
    J.col(column) << axis[i].cross(p_BF - origin[i]), axis[i];
  }
  Eigen::CompleteOrthogonalDecomposition<LegJacobian> decomposition(6, static_cast<Eigen::Index>(n));
  decomposition.setThreshold(kRank);
  decomposition.compute(J);
  leg.J_inverse = decomposition.pseudoInverse();

  const Eigen::Vector3d up_B = -motion.gravity_B;
  leg.lift_rad_m = leg.J_inverse.leftCols<3>() * up_B;
  leg.lifts = std::abs(up_B.dot(J.topRows<3>() * leg.lift_rad_m) - 1.0) < kLiftMiss;
}

double SoleLoads::error_N(Foot foot, const JointVector& acceleration_rad_s2) const noexcept {
  const Leg& leg = legs_[foot];
  if (!leg.lifts) return std::numeric_limits<double>::infinity();
  double squares_N2 = 0.0;
  for (std::size_t i = 0; i < leg.joints.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double inertia_Nm = leg.inertia_kg_m2[at] * acceleration_rad_s2[leg.joints[i]];
    squares_N2 += std::pow(leg.lift_rad_m[at] * std::hypot(leg.dry_friction_Nm[at], inertia_Nm), 2);
  }
  return std::sqrt(squares_N2);
}

PerFoot<SoleLoad> SoleLoads::of(const JointVector& torque_Nm) const noexcept {
  PerFoot<SoleLoad> loads;
  for (const Foot side : {kLeft, kRight}) {
    const Leg& leg = legs_[side];
    LegVector unexplained_Nm = leg.own_Nm;
    for (std::size_t i = 0; i < leg.joints.size(); ++i) {
      unexplained_Nm[static_cast<Eigen::Index>(i)] -= torque_Nm[leg.joints[i]];
    }
    const Eigen::Matrix<double, 6, 1> wrench_B = leg.J_inverse.transpose() * unexplained_Nm;
    const Eigen::Matrix3d R_FB = leg.R_BF.transpose();
    const Eigen::Vector3d force_F = R_FB * wrench_B.head<3>();
    const Eigen::Vector3d moment_F = R_FB * wrench_B.tail<3>() - leg.sole_center_F.cross(force_F);
    SoleLoad& load = loads[side];
    load.force_N = force_F.z();
    load.vertical_N = -gravity_B_.dot(wrench_B.head<3>());
    load.moment_Nm = moment_F.head<2>();
    if (load.force_N <= 0.0) continue;
    load.inside_m = std::min(leg.half_sole_m.x() - std::abs(moment_F.y() / load.force_N),
                             leg.half_sole_m.y() - std::abs(moment_F.x() / load.force_N));
  }
  return loads;
}

}  // namespace pmg::model
