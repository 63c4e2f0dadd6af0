#include "zero/standing_constraint.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace pmg::zero {

namespace {

KDL::Chain chain_to(const model::RobotModel& robot, const std::string& link) {
  KDL::Chain chain;
  robot.tree.getChain(robot.base_link, link, chain);
  return chain;
}

std::vector<int> joints_of(const model::RobotModel& robot, const KDL::Chain& chain) {
  std::vector<int> joints;
  for (const KDL::Segment& segment : chain.segments) {
    if (segment.getJoint().getType() != KDL::Joint::Fixed)
      joints.push_back(robot.joint_index.at(segment.getJoint().getName()));
  }
  return joints;
}

Eigen::Vector3d sole_center(const model::FootKinematics& foot) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : foot.sole_B) center += 0.25 * corner;
  return center;
}

}  // namespace

StandingConstraint::StandingConstraint(const model::RobotModel& robot)
    : legs_(robot),
      imu_chain_(chain_to(robot, robot.imu.link), joints_of(robot, chain_to(robot, robot.imu.link))),
      R_LI_(robot.imu.T_LI.linear()) {
  std::set<int> joints;
  for (const auto& leg : robot.leg_joints) joints.insert(leg.begin(), leg.end());
  for (std::size_t i = 0; i < imu_chain_.size(); ++i) joints.insert(imu_chain_.joint(i));
  joints_.assign(joints.begin(), joints.end());
}

Eigen::Matrix3d StandingConstraint::R_BI(const JointVector& q, const Eigen::Vector2d& imu_tilt_rad) {
  imu_chain_.compute(q);
  return imu_chain_.R() * R_LI_ *
         (Eigen::AngleAxisd(imu_tilt_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(imu_tilt_rad.x(), Eigen::Vector3d::UnitX()))
             .toRotationMatrix();
}

StandingMiss StandingConstraint::miss(const JointVector& q, const Eigen::Vector3d& gravity_I,
                                      const Eigen::Vector2d& imu_tilt_rad) {
  const Eigen::Vector3d up_B = -(R_BI(q, imu_tilt_rad) * gravity_I);
  const PerFoot<model::FootKinematics>& feet = legs_.compute(q, JointVector::Zero(q.size()));
  StandingMiss miss;
  for (const Foot foot : {kLeft, kRight}) {
    const Eigen::Vector3d up_F = feet[foot].R_BF.transpose() * up_B;
    miss.segment<2>(2 * static_cast<Eigen::Index>(foot)) = up_F.head<2>();
  }
  miss[4] = (sole_center(feet[kLeft]) - sole_center(feet[kRight])).dot(up_B);
  return miss;
}

// Central differences: simple and exact to 1e-9, at a few thousand forward kinematics in all.
Eigen::Matrix<double, 5, Eigen::Dynamic> StandingConstraint::jacobian(const JointVector& q,
                                                                      const Eigen::Vector3d& gravity_I,
                                                                      const Eigen::Vector2d& imu_tilt_rad) {
  constexpr double kStep_rad = 1e-5;
  const auto count = static_cast<Eigen::Index>(joints_.size());
  Eigen::Matrix<double, 5, Eigen::Dynamic> J(5, count + 2);
  for (Eigen::Index i = 0; i < count + 2; ++i) {
    const auto at = [&](double step_rad) {
      JointVector moved = q;
      Eigen::Vector2d tilt = imu_tilt_rad;
      if (i < count)
        moved[joints_[static_cast<std::size_t>(i)]] += step_rad;
      else
        tilt[i - count] += step_rad;
      return miss(moved, gravity_I, tilt);
    };
    J.col(i) = (at(kStep_rad) - at(-kStep_rad)) / (2.0 * kStep_rad);
  }
  return J;
}

PerFoot<Eigen::Vector3d> StandingConstraint::gravity_of_simulated(const JointVector& q,
                                                                  const Eigen::Vector2d& imu_tilt_rad) {
  const Eigen::Matrix3d R_IB = R_BI(q, imu_tilt_rad).transpose();
  const PerFoot<model::FootKinematics>& feet = legs_.compute(q, JointVector::Zero(q.size()));
  return {-(R_IB * feet[kLeft].R_BF.col(2)), -(R_IB * feet[kRight].R_BF.col(2))};
}

Eigen::Vector3d StandingConstraint::gravity_B(const JointVector& q, const Eigen::Vector3d& gravity_I) {
  return R_BI(q, Eigen::Vector2d::Zero()) * gravity_I;
}

}  // namespace pmg::zero
