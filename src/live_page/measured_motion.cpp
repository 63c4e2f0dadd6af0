#include "live_page/measured_motion.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::live_page {

namespace {

constexpr double kLeastShare = 0.25;  // of the weight: as little as hanging is told from standing by

/// The foot that stands; nothing: the robot hangs, or it isn't known.
std::optional<Foot> stance_of(const pmg_msgs::status_t& status) {
  const Foot stance = status.foot_load[kLeft] >= status.foot_load[kRight] ? kLeft : kRight;
  if (!(status.foot_load[stance] >= kLeastShare) || status.hanging != 0) return std::nullopt;
  return stance;
}

/// Pitch and roll [rad] of Ry(pitch) Rx(roll), whose third row is up.
std::array<double, 2> pitch_roll(const Eigen::Vector3d& up) {
  return {std::asin(std::clamp(-up.x(), -1.0, 1.0)), std::atan2(up.y(), up.z())};
}

bool finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

}  // namespace

MeasuredMotion::MeasuredMotion(const model::RobotModel& robot)
    : legs_(robot),
      base_to_imu_(model::chain_between(robot, robot.base_link, robot.imu.link)),
      base_to_torso_(model::chain_between(robot, robot.base_link, robot.torso_link)),
      R_LI_(robot.imu.T_LI.linear()),
      standing_height_m_(robot.standing_height_m),
      q_(JointVector::Zero(static_cast<Eigen::Index>(robot.joints.size()))),
      dq_(q_) {}

void MeasuredMotion::take(const ops::RobotNews& news) noexcept {
  if (!news.state || news.state->stamp_ns == stamp_ns_) return;
  const pmg_msgs::robot_state_t& state = *news.state;
  const auto joints = static_cast<std::size_t>(q_.size());
  const Eigen::Quaterniond R_WI(state.orientation_WI[0], state.orientation_WI[1], state.orientation_WI[2],
                                state.orientation_WI[3]);
  const bool whole = state.q_rad.size() == joints && state.dq_rad_s.size() == joints &&
                     finite(state.q_rad.data(), joints) && finite(state.dq_rad_s.data(), joints) &&
                     finite(state.gyro_rad_s, 3) && std::abs(R_WI.norm() - 1.0) < 1e-3;
  const double dt_s = static_cast<double>(state.stamp_ns - stamp_ns_) * 1e-9;
  stamp_ns_ = state.stamp_ns;
  if (!whole) {
    tilt_.reset();
    smooth_.reset();
    return;
  }
  q_ = Eigen::Map<const Eigen::VectorXd>(state.q_rad.data(), q_.size());
  dq_ = Eigen::Map<const Eigen::VectorXd>(state.dq_rad_s.data(), q_.size());
  base_to_imu_.compute(q_);
  R_BI_ = base_to_imu_.R() * R_LI_;
  up_B_ = R_BI_ * (R_WI.conjugate() * Eigen::Vector3d::UnitZ());
  omega_B_ = R_BI_ * Eigen::Map<const Eigen::Vector3d>(state.gyro_rad_s);
  const auto [base_pitch, base_roll] = pitch_roll(up_B_);
  tilt_ =
      Eigen::AngleAxisd(base_pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(base_roll, Eigen::Vector3d::UnitX());
  const auto stance = stance_of(news.status);
  if (!stance) {
    smooth_.reset();
    return;
  }
  feet_ = legs_.compute(q_, dq_);
  base_to_torso_.compute(q_);
  const std::array<double, kChannels> now = measure(*stance);
  if (!smooth_ || dt_s < 0.0 || dt_s > kPause_s) {
    smooth_ = now;
    return;
  }
  const double share = 1.0 - std::exp(-dt_s / kSmooth_s);
  for (std::size_t i = 0; i < kChannels; ++i) (*smooth_)[i] += share * (now[i] - (*smooth_)[i]);
}

std::array<double, kChannels> MeasuredMotion::measure(Foot stance) const noexcept {
  const Eigen::Matrix3d R_HB = tilt_->toRotationMatrix();
  const model::FootKinematics& foot = feet_[stance];
  Eigen::Vector3d sole_B = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : foot.sole_B) sole_B += 0.25 * corner;
  const Eigen::Vector3d v_sole_B = foot.v_BF + foot.omega_BF.cross(sole_B - foot.p_BF);
  const Eigen::Vector3d v_H = -(R_HB * (v_sole_B + omega_B_.cross(sole_B)));
  const auto [pitch, roll] = pitch_roll(base_to_torso_.R().transpose() * up_B_);
  std::array<double, kChannels> u{};
  u[kVx] = v_H.x();
  u[kVy] = v_H.y();
  u[kOmega] = (R_HB * omega_B_).z();
  u[kPitch] = pitch;
  u[kRoll] = roll;
  u[kHeight] = -(R_HB * sole_B).z() - standing_height_m_;
  return u;
}

}  // namespace pmg::live_page
