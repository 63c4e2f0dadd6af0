#include "calib/sole_load.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace pmg::calib {

namespace {

constexpr double kGravity_m_s2 = 9.81;

KDL::JntArray leg_angles(const std::vector<int>& joints, const JointVector& q) {
  KDL::JntArray angles(static_cast<unsigned>(joints.size()));
  for (unsigned i = 0; i < joints.size(); ++i) angles(i) = q[joints[i]];
  return angles;
}

}  // namespace

SoleLoads::SoleLoads(const model::RobotModel& robot) : robot_(robot), legs_(robot) {}

PerFoot<SoleLoad> SoleLoads::of(const JointVector& q, const JointVector& torque_Nm, const Eigen::Vector3d& gravity_B) {
  const PerFoot<model::FootKinematics>& feet = legs_.compute(q, JointVector::Zero(q.size()));
  const Eigen::Vector3d g = kGravity_m_s2 * gravity_B;
  PerFoot<SoleLoad> loads;
  for (const Foot side : {kLeft, kRight}) {
    const std::vector<int>& joints = robot_.leg_joints[side];
    KDL::ChainDynParam dynamics(robot_.leg_chain[side], KDL::Vector(g.x(), g.y(), g.z()));
    KDL::JntArray held(static_cast<unsigned>(joints.size()));
    dynamics.JntToGravity(leg_angles(joints, q), held);
    Eigen::VectorXd unexplained_Nm(static_cast<Eigen::Index>(joints.size()));
    for (unsigned i = 0; i < joints.size(); ++i) unexplained_Nm[i] = held(i) - torque_Nm[joints[i]];
    const model::FootKinematics& foot = feet[side];
    const Eigen::MatrixXd J_transposed = foot.J.transpose();
    const Eigen::VectorXd wrench_B = J_transposed.completeOrthogonalDecomposition().solve(unexplained_Nm);

    const model::FootModel& sole = robot_.feet[side];
    const Eigen::Vector3d center_F = sole.box_center_F - Eigen::Vector3d(0.0, 0.0, sole.box_half_size_m.z());
    const Eigen::Vector3d force_F = foot.R_BF.transpose() * wrench_B.head<3>();
    const Eigen::Vector3d moment_F = foot.R_BF.transpose() * wrench_B.tail<3>() - center_F.cross(force_F);
    SoleLoad& load = loads[side];
    load.force_N = force_F.z();
    load.moment_Nm = moment_F.head<2>();
    if (load.force_N <= 0.0) continue;
    load.inside_m = std::min(sole.box_half_size_m.x() - std::abs(moment_F.y() / load.force_N),
                             sole.box_half_size_m.y() - std::abs(moment_F.x() / load.force_N));
  }
  return loads;
}

}  // namespace pmg::calib
