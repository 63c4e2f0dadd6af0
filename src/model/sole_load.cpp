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

SoleLoads::SoleLoads(const RobotModel& robot) : legs_{leg(robot, kLeft), leg(robot, kRight)} {
  set_posture(robot.q_stand(), gravity_B_);
}

SoleLoads::Leg SoleLoads::leg(const RobotModel& robot, Foot side) {
  const std::vector<int>& joints = robot.leg_joints[side];
  const FootModel& foot = robot.feet[side];
  const auto n = static_cast<Eigen::Index>(joints.size());
  Leg leg{.chain = robot.leg_chain[side],
          .joints = joints,
          .dry_friction_Nm = LegVector::Zero(n),
          .sole_center_F = foot.box_center_F - Eigen::Vector3d(0.0, 0.0, foot.box_half_size_m.z()),
          .half_sole_m = foot.box_half_size_m.head<2>(),
          .gravity_Nm = LegVector::Zero(n),
          .J_inverse = {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    leg.dry_friction_Nm[i] = robot.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(i)])].friction_Nm;
  }
  return leg;
}

void SoleLoads::set_posture(const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept {
  gravity_B_ = gravity_B;
  for (Leg& leg : legs_) compute(leg, q, gravity_B);
}

void SoleLoads::compute(Leg& leg, const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept {
  const std::size_t n = leg.joints.size();
  // For each moving joint: its axis, a point on it, and mass and first moment of the links up to the next joint.
  std::array<Eigen::Vector3d, kMaxLegJoints> axis, origin, moment_kg_m;
  std::array<double, kMaxLegJoints> mass_kg{};
  moment_kg_m.fill(Eigen::Vector3d::Zero());
  KDL::Frame pose = KDL::Frame::Identity();
  std::size_t moving = 0;
  for (const KDL::Segment& segment : leg.chain.segments) {
    const KDL::Joint& joint = segment.getJoint();
    double angle_rad = 0.0;
    if (joint.getType() != KDL::Joint::Fixed) {
      axis[moving] = to_eigen(pose.M * joint.JointAxis());
      origin[moving] = to_eigen(pose * joint.JointOrigin());
      angle_rad = q[leg.joints[moving]];
      ++moving;
    }
    pose = pose * segment.pose(angle_rad);
    const KDL::RigidBodyInertia& link = segment.getInertia();
    if (moving == 0) continue;  // fixed to the base
    mass_kg[moving - 1] += link.getMass();
    moment_kg_m[moving - 1] += link.getMass() * to_eigen(pose * link.getCOG());
  }
  leg.R_BF = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.M.data);
  const Eigen::Vector3d p_BF = to_eigen(pose.p);

  LegJacobian J(6, static_cast<Eigen::Index>(n));
  double below_kg = 0.0;
  Eigen::Vector3d below_kg_m = Eigen::Vector3d::Zero();
  for (std::size_t i = n; i-- > 0;) {
    const auto column = static_cast<Eigen::Index>(i);
    below_kg += mass_kg[i];
    below_kg_m += moment_kg_m[i];
    leg.gravity_Nm[column] = -kGravity_m_s2 * axis[i].dot((below_kg_m - below_kg * origin[i]).cross(gravity_B));
    J.col(column) << axis[i].cross(p_BF - origin[i]), axis[i];
  }
  Eigen::CompleteOrthogonalDecomposition<LegJacobian> decomposition(6, static_cast<Eigen::Index>(n));
  decomposition.setThreshold(kRank);
  decomposition.compute(J);
  leg.J_inverse = decomposition.pseudoInverse();

  const Eigen::Vector3d up_B = -gravity_B;
  const LegVector lift = leg.J_inverse.leftCols<3>() * up_B;  // joint rates that raise the foot by 1 m/s
  const double raised = up_B.dot(J.topRows<3>() * lift);
  leg.friction_N = std::abs(raised - 1.0) < kLiftMiss ? lift.cwiseProduct(leg.dry_friction_Nm).norm()
                                                      : std::numeric_limits<double>::infinity();
}

PerFoot<SoleLoad> SoleLoads::of(const JointVector& torque_Nm) const noexcept {
  PerFoot<SoleLoad> loads;
  for (const Foot side : {kLeft, kRight}) {
    const Leg& leg = legs_[side];
    LegVector unexplained_Nm = leg.gravity_Nm;
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
