#include "control/limiter.hpp"

#include <algorithm>

namespace pmg::control {

namespace {

/// Clamps value. If that changes it, the joint's bit is set and the joint counted.
void clamp_into(double low, double high, double& value, std::uint8_t bit, std::uint8_t& by, int& count) noexcept {
  const double clamped = std::clamp(value, low, high);
  if (clamped != value) {
    by = static_cast<std::uint8_t>(by | bit);
    ++count;
  }
  value = clamped;
}

}  // namespace

Limiter::Limiter(const model::RobotModel& robot, const JointVector& kp, const JointVector& kd, double dt_s,
                 const LimiterOptions& options)
    : lower_(robot.q_lower()), upper_(robot.q_upper()), kp_(kp), kd_(kd), previous_(robot.q_stand()) {
  const Eigen::Index n = lower_.size();
  for (JointVector* values : {&step_, &effort_}) values->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    step_[i] = joint.velocity_limit_rad_s * options.target_rate_factor * dt_s;
    effort_[i] = joint.effort_limit_Nm;
  }
}

void Limiter::start_from(const JointVector& q) noexcept { previous_ = q; }

LimitReport Limiter::apply(const model::RobotState& state, const JointVector& dq_des, JointVector& q_des) noexcept {
  LimitReport report;
  for (Eigen::Index i = 0; i < q_des.size(); ++i) {
    std::uint8_t& by = report.by[static_cast<std::size_t>(i)];
    clamp_into(previous_[i] - step_[i], previous_[i] + step_[i], q_des[i], LimitReport::kSpeed, by, report.rate);
    if (kp_[i] > 0.0) {
      const double braking_rad = kd_[i] * (state.dq[i] - dq_des[i]) / kp_[i], reach_rad = effort_[i] / kp_[i];
      clamp_into(state.q[i] + braking_rad - reach_rad, state.q[i] + braking_rad + reach_rad, q_des[i],
                 LimitReport::kTorque, by, report.torque);
    }
    clamp_into(lower_[i], upper_[i], q_des[i], LimitReport::kRange, by, report.position);
  }
  previous_ = q_des;
  return report;
}

}  // namespace pmg::control
