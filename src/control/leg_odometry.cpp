#include "control/leg_odometry.hpp"

#include <cmath>

#include "gco/contact_point.hpp"
#include "model/link_chain.hpp"

namespace pmg::control {

LegOdometry::LegOdometry(const model::RobotModel& robot)
    : legs_(robot),
      base_to_imu_link_(model::chain_between(robot, robot.base_link, robot.imu.link)),
      R_LI_(robot.imu.T_LI.linear()) {}

std::optional<std::array<double, kVelocityChannels>> LegOdometry::velocity_H(const model::RobotState& state,
                                                                             const PerFoot<double>& weight) noexcept {
  if (!(weight[kLeft] + weight[kRight] > 0.0)) return std::nullopt;
  base_to_imu_link_.compute(state.q);
  const Eigen::Matrix3d R_BI = base_to_imu_link_.R() * R_LI_;
  const Eigen::Matrix3d R_WB = state.orientation_WI.toRotationMatrix() * R_BI.transpose();
  const double norm = std::hypot(R_WB(0, 0), R_WB(1, 0));
  if (!(norm > 0.0)) return std::nullopt;
  const double c = R_WB(0, 0) / norm, s = R_WB(1, 0) / norm;
  Eigen::Matrix3d R_HW;
  R_HW << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d R_HB = R_HW * R_WB;
  const Eigen::Vector3d omega_B = R_BI * state.gyro_rad_s;  // the IMU link is rigid with the base
  const auto& feet = legs_.compute(state.q, state.dq);
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();
  for (const Foot foot : {kLeft, kRight}) {
    if (!(weight[foot] > 0.0)) continue;
    const Eigen::Vector3d p_B = gco::contact_point(feet[foot].sole_B, R_HB).p_BC;
    const Eigen::Vector3d v_B = feet[foot].v_BF + feet[foot].omega_BF.cross(p_B - feet[foot].p_BF) + omega_B.cross(p_B);
    v_H -= weight[foot] * (R_HB * v_B);
  }
  v_H /= weight[kLeft] + weight[kRight];
  const double yaw_rate = (R_HB * omega_B).z();
  if (!v_H.allFinite() || !std::isfinite(yaw_rate)) return std::nullopt;
  return std::array{v_H.x(), v_H.y(), yaw_rate};
}

}  // namespace pmg::control
