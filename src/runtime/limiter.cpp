#include "runtime/limiter.hpp"

#include <algorithm>

namespace pmg::runtime {

namespace {

/// Clamps value; one if that changed it.
int clamp_into(double low, double high, double& value) noexcept {
  const double clamped = std::clamp(value, low, high);
  const int changed = clamped == value ? 0 : 1;
  value = clamped;
  return changed;
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

LimitReport Limiter::apply(const model::RobotState& state, JointVector& q_des) noexcept {
  LimitReport report;
  for (Eigen::Index i = 0; i < q_des.size(); ++i) {
    report.rate += clamp_into(previous_[i] - step_[i], previous_[i] + step_[i], q_des[i]);
    if (kp_[i] > 0.0) {
      const double braking_rad = kd_[i] * state.dq[i] / kp_[i], reach_rad = effort_[i] / kp_[i];
      report.torque += clamp_into(state.q[i] + braking_rad - reach_rad, state.q[i] + braking_rad + reach_rad, q_des[i]);
    }
    report.position += clamp_into(lower_[i], upper_[i], q_des[i]);
  }
  previous_ = q_des;
  return report;
}

}  // namespace pmg::runtime
