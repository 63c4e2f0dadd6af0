// RobotEquations' part about contacts: support, foot forces, and the accelerometer's share of torques.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pmg/types.hpp"
#include "robot_diagnosis/robot_equations.hpp"

namespace pmg::robot_diagnosis {

Eigen::Vector3d RobotEquations::accelerometer_share(const JointVector& q, const JointVector& torque_Nm) {
  return robot_.imu.T_LI.linear().transpose() * dynamics_.imu_acceleration(q, torque_Nm);
}

Eigen::Vector3d RobotEquations::imu_velocity_on_resting_soles(const model::RobotState& state) {
  const Eigen::Isometry3d& T_BI = robot_.imu.T_LI;
  const Eigen::Vector3d omega_B = T_BI.linear() * state.gyro_rad_s;
  GeneralizedVector speed = GeneralizedVector::Zero(6 + joints_);
  speed.segment<3>(3) = omega_B;
  speed.tail(joints_) = state.dq;
  dynamics_.take_posture(state.q);
  Eigen::Vector3d v_base_B = Eigen::Vector3d::Zero();  // base velocity at which the feet's mean velocity is 0
  for (const Foot foot : {kLeft, kRight})
    v_base_B -= 0.5 * (dynamics_.jacobian_of_link(foot_body_[foot]) * speed).head<3>();
  return T_BI.linear().transpose() * (v_base_B + omega_B.cross(T_BI.translation()));
}

PerFoot<FootForce> RobotEquations::foot_forces(const RobotSample& sample) {
  PerFoot<FootForce> forces;
  if (!legs_of_six_) return forces;
  const GeneralizedVector force = missing(sample, {});
  const Eigen::Vector3d up_B = robot_.imu.T_LI.linear() * sample.up_I;
  for (const Foot foot : {kLeft, kRight}) {
    const Eigen::Vector3d on_foot_N = foot_wrench(force, foot).head<3>();
    forces[foot].normal_N = on_foot_N.dot(up_B);
    forces[foot].tangential_N = (on_foot_N - forces[foot].normal_N * up_B).norm();
  }
  return forces;
}

double RobotEquations::foot_separation_speed_m_s(const RobotSample& sample) {
  missing(sample, {});
  GeneralizedVector speed = GeneralizedVector::Zero(6 + joints_);
  speed.segment<3>(3) = robot_.imu.T_LI.linear() * sample.omega_I;
  speed.tail(joints_) = sample.dq;
  const Eigen::Vector3d left = (dynamics_.jacobian_of_link(foot_body_[kLeft]) * speed).head<3>();
  const Eigen::Vector3d right = (dynamics_.jacobian_of_link(foot_body_[kRight]) * speed).head<3>();
  return (left - right).norm();
}

Support RobotEquations::support(const RobotSample& sample) {
  if (!legs_of_six_) return Support::kLoose;
  const Eigen::Vector3d up_B = robot_.imu.T_LI.linear() * sample.up_I;
  if (up_B.z() < support_.least_upright) return Support::kLoose;
  const double weight_N = robot_.total_mass_kg * kGravity_m_s2;
  const PerFoot<FootForce> forces = foot_forces(sample);
  const auto most = [](const FootForce& f) { return std::max(std::abs(f.normal_N), f.tangential_N); };
  if (std::max(most(forces[kLeft]), most(forces[kRight])) < support_.most_in_the_air * weight_N)
    return Support::kHanging;
  const double sum_N = forces[kLeft].normal_N + forces[kRight].normal_N;
  const bool loaded =
      std::min(forces[kLeft].normal_N, forces[kRight].normal_N) > support_.least_on_the_ground * weight_N &&
      sum_N > support_.least_weight * weight_N && sum_N < support_.most_weight * weight_N;
  if (!loaded || foot_separation_speed_m_s(sample) > support_.stepping_m_s) return Support::kLoose;
  for (const Foot foot : {kLeft, kRight}) {
    const Eigen::Vector3d up_F = dynamics_.rotation(foot_body_[foot]).transpose() * up_B;
    if (up_F.head<2>().norm() > support_.flat_rad) return Support::kLoose;
  }
  return Support::kStanding;
}

}  // namespace pmg::robot_diagnosis
