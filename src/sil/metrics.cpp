#include "sil/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::sil {

namespace {
constexpr double kLongestGaitPeriod_s = 4.0;
constexpr double kLoadedFoot_N = 20.0;  // a foot that barely touches slides without meaning
}  // namespace

RollPitch roll_pitch(const Eigen::Quaterniond& q_WT) {
  const Eigen::Matrix3d R_WT = q_WT.toRotationMatrix();
  return {.roll_rad = std::atan2(R_WT(2, 1), R_WT(2, 2)), .pitch_rad = std::asin(std::clamp(-R_WT(2, 0), -1.0, 1.0))};
}

Metrics::Metrics(double standing_height_m, double dt_s)
    : standing_height_m_(standing_height_m),
      dt_s_(dt_s),
      ring_(static_cast<std::size_t>(std::lround(kLongestGaitPeriod_s / dt_s))) {}

void Metrics::add(const model::GroundTruth& truth, const Command& user, double gait_period_s) {
  watch_for_fall(truth);

  const Eigen::Matrix3d R_WB = truth.q_WB.toRotationMatrix();
  const double pelvis_yaw_rad = std::atan2(R_WB(1, 0), R_WB(0, 0));
  Sample& sample = push();
  sample.cos_yaw = std::cos(pelvis_yaw_rad);
  sample.sin_yaw = std::sin(pelvis_yaw_rad);
  const Sample heading = average(gait_period_s);
  const double scale = std::max(std::hypot(heading.cos_yaw, heading.sin_yaw), 1e-12);
  const double c = heading.cos_yaw / scale, s = heading.sin_yaw / scale;

  const double alive = fell_ ? 0.0 : 1.0;
  const Eigen::Vector3d& v_W = truth.v_WB_W;
  sample.error_x_m_s = alive * (c * v_W.x() + s * v_W.y()) - user[kVx];
  sample.error_y_m_s = alive * (c * v_W.y() - s * v_W.x()) - user[kVy];
  sample.error_yaw_rad_s = alive * (R_WB * truth.omega_WB_B).z() - user[kOmega];
  const RollPitch torso = roll_pitch(truth.q_WT);
  sample.error_roll_rad = torso.roll_rad - user[kRoll];
  sample.error_pitch_rad = torso.pitch_rad - user[kPitch];
  sample.error_height_m = alive * truth.p_WB.z() - (standing_height_m_ + user[kHeight]);

  const Sample mean = average(gait_period_s);
  sums_.lin_vel_mae_m_s += std::hypot(mean.error_x_m_s, mean.error_y_m_s);
  sums_.lin_vel_raw_mae_m_s += std::hypot(sample.error_x_m_s, sample.error_y_m_s);
  sums_.yaw_vel_mae_rad_s += std::abs(mean.error_yaw_rad_s);
  sums_.yaw_vel_raw_mae_rad_s += std::abs(sample.error_yaw_rad_s);
  sums_.roll_mae_rad += std::abs(mean.error_roll_rad);
  sums_.roll_raw_mae_rad += std::abs(sample.error_roll_rad);
  sums_.pitch_mae_rad += std::abs(mean.error_pitch_rad);
  sums_.pitch_raw_mae_rad += std::abs(sample.error_pitch_rad);
  sums_.height_mae_m += std::abs(mean.error_height_m);
  sums_.height_raw_mae_m += std::abs(sample.error_height_m);
  for (const std::size_t foot : {kLeft, kRight}) {
    if (truth.foot_force_N[foot] < kLoadedFoot_N) continue;
    sums_.foot_slip_mean_m_s += truth.foot_slip_m_s[foot];
    ++slip_samples_;
  }
  ++ticks_;
  elapsed_s_ += dt_s_;
}

void Metrics::skip(const model::GroundTruth& truth) {
  watch_for_fall(truth);
  filled_ = 0;
  elapsed_s_ += dt_s_;
}

void Metrics::watch_for_fall(const model::GroundTruth& truth) {
  if (fell_) return;
  const double tilt_rad = std::acos(std::clamp((truth.q_WT * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  fell_ = truth.p_WB.z() < kFallenHeightShare * standing_height_m_ || tilt_rad > kFallenTilt_rad;
  if (fell_) fell_at_s_ = elapsed_s_;
}

Metrics::Sample& Metrics::push() {
  newest_ = (newest_ + 1) % ring_.size();
  filled_ = std::min(filled_ + 1, ring_.size());
  ring_[newest_] = Sample{};
  return ring_[newest_];
}

Metrics::Sample Metrics::average(double gait_period_s) const {
  const auto wanted = static_cast<std::size_t>(std::max(1L, std::lround(gait_period_s / dt_s_)));
  const std::size_t count = std::min(wanted, filled_);
  Sample mean{.cos_yaw = 0.0};
  const double share = 1.0 / static_cast<double>(count);
  for (std::size_t back = 0; back < count; ++back) {
    const Sample& sample = ring_[(newest_ + ring_.size() - back) % ring_.size()];
    for (double Sample::*const value :
         {&Sample::cos_yaw, &Sample::sin_yaw, &Sample::error_x_m_s, &Sample::error_y_m_s, &Sample::error_yaw_rad_s,
          &Sample::error_roll_rad, &Sample::error_pitch_rad, &Sample::error_height_m}) {
      mean.*value += share * sample.*value;
    }
  }
  return mean;
}

TrackingSummary Metrics::summary() const {
  TrackingSummary mean = sums_;
  const double share = ticks_ > 0 ? 1.0 / static_cast<double>(ticks_) : 0.0;
  for (double* sum : {&mean.lin_vel_mae_m_s, &mean.lin_vel_raw_mae_m_s, &mean.yaw_vel_mae_rad_s,
                      &mean.yaw_vel_raw_mae_rad_s, &mean.roll_mae_rad, &mean.roll_raw_mae_rad, &mean.pitch_mae_rad,
                      &mean.pitch_raw_mae_rad, &mean.height_mae_m, &mean.height_raw_mae_m}) {
    *sum *= share;
  }
  mean.foot_slip_mean_m_s = slip_samples_ > 0 ? sums_.foot_slip_mean_m_s / static_cast<double>(slip_samples_) : 0.0;
  mean.followed_s = static_cast<double>(ticks_) * dt_s_;
  return mean;
}

}  // namespace pmg::sil
