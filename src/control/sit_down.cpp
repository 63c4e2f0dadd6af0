#include "control/sit_down.hpp"

#include <cmath>
#include <stdexcept>

#include "control/drive_gains.hpp"
#include "model/crouch.hpp"

namespace pmg::control {

namespace {

constexpr double kLongest_s = 1.0;

const SitDownOptions& checked(const SitDownOptions& options) {
  if (!(options.duration_s >= 0.0 && options.settle_s >= 0.0 && options.duration_s + options.settle_s <= kLongest_s)) {
    throw std::invalid_argument("sit_down: duration_s and settle_s; expected 0 or more, and 1 s together at most");
  }
  return options;
}

}  // namespace

SitDown::SitDown(const model::RobotModel& robot, const ClipLibrary& library, const SitDownOptions& options)
    : options_(checked(options)),
      own_(own_gains(robot)),
      crouch_(library.q_stand),
      from_(library.q_stand),
      ramp_({.speed_rad_s = 1.0, .shortest_s = options.duration_s, .longest_s = options.duration_s}) {
  const StaticClip& height = library.posture[kHeight - kVelocityChannels];
  known_ = options_.duration_s > 0.0 && !height.command.empty() && height.command.front() < 0.0;
  if (known_) crouch_ = model::deepest_crouch(robot, height.q.front());
}

void SitDown::start(const JointVector& q, const JointVector& q_des, const JointVector& kp,
                    std::int64_t now_ns) noexcept {
  if (!known_) return;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    from_[i] = own_.kp_Nm_per_rad[i] > 0.0 ? q[i] + kp[i] * (q_des[i] - q[i]) / own_.kp_Nm_per_rad[i] : q_des[i];
  }
  ramp_.start(from_, crouch_);
  end_ns_ = now_ns + std::llround((options_.duration_s + options_.settle_s) * 1e9);
}

void SitDown::step(double dt_s, model::JointCommand& command) noexcept {
  command.q = crouch_;
  ramp_.apply(dt_s, command.q);
  command.dq.setZero();
  command.tau_ff.setZero();
  command.kp = own_.kp_Nm_per_rad;
  command.kd = own_.kd_Nm_s_per_rad;
}

}  // namespace pmg::control
