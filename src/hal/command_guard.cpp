#include "hal/command_guard.hpp"

#include <algorithm>

namespace pmg::hal {

CommandGuard::CommandGuard(const model::RobotModel& robot, const GuardOptions& options)
    : options_(options),
      lower_(robot.q_lower()),
      upper_(robot.q_upper()),
      velocity_(lower_.size()),
      effort_(lower_.size()) {
  const Eigen::Index n = lower_.size();
  brake_.q = robot.q_stand();
  for (JointVector* values : {&brake_.dq, &brake_.kp, &brake_.tau_ff}) values->setZero(n);
  brake_.kd.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    brake_.kd[i] = joint.kd_Nm_s_per_rad;
    velocity_[i] = joint.velocity_limit_rad_s;
    effort_[i] = joint.effort_limit_Nm;
  }
  newest_.joints = brake_;
  newest_.joints.kd.setZero();
}

const model::JointCommand& CommandGuard::next(const ControlOutput* fresh, std::uint32_t stop_pulls) noexcept {
  if (fresh != nullptr) {
    any_ = true;
    age_cycles_ = 0;
    newest_ = *fresh;
    if (plausible(newest_.joints)) {
      clamp(newest_.joints);
    } else {
      trip(TripCause::kCommandNotFinite);
    }
  } else if (any_ && age_cycles_ <= options_.hold_cycles) {
    ++age_cycles_;
    if (age_cycles_ > options_.hold_cycles) trip(TripCause::kControlFrozen);
  }
  damping_ = any_ && (newest_.trips_seen != trips_ || newest_.stops_seen != stop_pulls);
  return damping_ ? brake_ : newest_.joints;
}

bool CommandGuard::plausible(const model::JointCommand& command) const noexcept {
  for (const JointVector* values : {&command.q, &command.dq, &command.kp, &command.kd, &command.tau_ff}) {
    if (values->size() != lower_.size() || !values->allFinite()) return false;
  }
  return true;
}

void CommandGuard::clamp(model::JointCommand& command) const noexcept {
  command.q = command.q.cwiseMax(lower_).cwiseMin(upper_);
  command.dq = command.dq.cwiseMax(-velocity_).cwiseMin(velocity_);
  command.kp = command.kp.cwiseMax(0.0).cwiseMin(options_.max_kp_Nm_per_rad);
  command.kd = command.kd.cwiseMax(0.0).cwiseMin(options_.max_kd_Nm_s_per_rad);
  command.tau_ff = command.tau_ff.cwiseMax(-effort_).cwiseMin(effort_);
}

void CommandGuard::trip(TripCause cause) noexcept {
  ++trips_;
  cause_ = cause;
}

}  // namespace pmg::hal
