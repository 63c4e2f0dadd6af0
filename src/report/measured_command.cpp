#include "report/measured_command.hpp"

#include <algorithm>
#include <cmath>

#include "sil/metrics.hpp"

namespace pmg::report {

namespace {
constexpr double kLongestGaitPeriod_s = 4.0;

}  // namespace

std::array<double, kChannels> MeasuredCommand::add(const pmg_msgs::ground_truth_t& truth, double gait_period_s,
                                                   double standing_height_m) {
  const double time_s = static_cast<double>(truth.stamp_ns) * 1e-9;
  const double period_s = std::clamp(gait_period_s, 0.0, kLongestGaitPeriod_s);
  if (!samples_.empty()) {
    const double step_s = time_s - samples_.back().time_s;
    if (step_s <= 0.0 || step_s > period_s) samples_.clear();
  }
  const Eigen::Matrix3d R_WB = to_quaternion(truth.q_WB).toRotationMatrix();
  const Eigen::Map<const Eigen::Vector3d> omega_B(truth.omega_WB_B_rad_s);
  const double yaw_rad = std::atan2(R_WB(1, 0), R_WB(0, 0));
  samples_.push_back({.time_s = time_s,
                      .vx_W_m_s = truth.v_WB_W_m_s[0],
                      .vy_W_m_s = truth.v_WB_W_m_s[1],
                      .yaw_rate_rad_s = R_WB.row(2).dot(omega_B),
                      .cos_yaw = std::cos(yaw_rad),
                      .sin_yaw = std::sin(yaw_rad)});
  while (samples_.size() > 1 && samples_.front().time_s <= time_s - period_s) samples_.pop_front();

  Sample sum{};
  for (const Sample& sample : samples_) {
    sum.vx_W_m_s += sample.vx_W_m_s;
    sum.vy_W_m_s += sample.vy_W_m_s;
    sum.yaw_rate_rad_s += sample.yaw_rate_rad_s;
    sum.cos_yaw += sample.cos_yaw;
    sum.sin_yaw += sample.sin_yaw;
  }
  const double share = 1.0 / static_cast<double>(samples_.size());
  const double scale = std::max(std::hypot(sum.cos_yaw, sum.sin_yaw), 1e-12);
  const double c = sum.cos_yaw / scale, s = sum.sin_yaw / scale;
  const sil::RollPitch torso = sil::roll_pitch(to_quaternion(truth.q_WT));
  std::array<double, kChannels> measured{};
  measured[kVx] = share * (c * sum.vx_W_m_s + s * sum.vy_W_m_s);
  measured[kVy] = share * (c * sum.vy_W_m_s - s * sum.vx_W_m_s);
  measured[kOmega] = share * sum.yaw_rate_rad_s;
  measured[kPitch] = torso.pitch_rad;
  measured[kRoll] = torso.roll_rad;
  measured[kHeight] = truth.p_WB_m[2] - standing_height_m;
  return measured;
}

bool fallen(const pmg_msgs::ground_truth_t& truth, double standing_height_m) {
  const Eigen::Vector3d up_W = to_quaternion(truth.q_WT) * Eigen::Vector3d::UnitZ();
  return truth.p_WB_m[2] < sil::Metrics::kFallenHeightShare * standing_height_m ||
         up_W.z() < std::cos(sil::Metrics::kFallenTilt_rad);
}

}  // namespace pmg::report
