#include "control/sit_down.hpp"

#include <cmath>
#include <stdexcept>

#include "control/drive_gains.hpp"
#include "model/crouch.hpp"

namespace pmg::control {

namespace {

constexpr double kLongest_s = 1.0;
constexpr double kRounding_s = 1e-6;

const SitDownOptions& checked(const SitDownOptions& options) {
  if (!(options.balanced.crouch_s >= 0.0 && options.settle_s >= 0.0 &&
        options.balanced.crouch_s + options.settle_s <= kLongest_s + 1e-9)) {
    throw std::invalid_argument("sit_down: crouch_s and settle_s; expected 0 or more, and 1 s together at most");
  }
  for (const WayDown& way : {options.balanced, options.unbalanced}) {
    const bool none = options.balanced.crouch_s == 0.0;
    if (!(way.reference_s >= 0.0 && (none || way.reference_s < way.crouch_s))) {
      throw std::invalid_argument("sit_down: reference_s; expected 0 or more, and less than crouch_s");
    }
    if (!(none || way.crouch_s <= options.balanced.crouch_s)) {
      throw std::invalid_argument("sit_down: the unbalanced way; expected a crouch_s of the balanced one's at most");
    }
    if (!(std::abs(way.ahead_share) < 1.0)) {
      throw std::invalid_argument("sit_down: ahead_share; expected the centre of mass over the soles, -1 to 1");
    }
  }
  if (!(options.brake_factor >= 1.0 && options.height_rate_m_s > 0.0)) {
    throw std::invalid_argument("sit_down: brake_factor and height_rate_m_s; expected 1 or more, and more than 0");
  }
  return options;
}

double seconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-9; }

/// (share of the time) => (share of the way), with a trapezoid of speed: a fifth of the time each to accelerate and to
/// brake. A robot that is lowered evenly moves least.
double share_of_way(double t) {
  constexpr double kAccelerating = 0.2, kSpeed = 1.0 / (1.0 - kAccelerating);
  if (t >= 1.0) return 1.0;
  if (t > 0.5) return 1.0 - share_of_way(1.0 - t);
  return t < kAccelerating ? 0.5 * kSpeed * t * t / kAccelerating : kSpeed * (t - 0.5 * kAccelerating);
}

}  // namespace

SitDown::SitDown(const model::RobotModel& robot, const ClipLibrary& library, const SitDownOptions& options,
                 const hal::GuardOptions& guard)
    : options_(checked(options)),
      own_(own_gains(robot)),
      crouches_{library.q_stand, library.q_stand},
      from_(library.q_stand),
      brake_kd_((options.brake_factor * own_.kd_Nm_s_per_rad).cwiseMin(guard.max_kd_Nm_s_per_rad)),
      squat_rad_(library.q_stand) {
  const StaticClip& height = library.posture[kHeight - kVelocityChannels];
  if (options_.balanced.crouch_s == 0.0 || height.command.empty() || height.command.front() >= 0.0) return;
  lowest_m_ = height.command.front();
  squat_rad_ = height.q.front();
  crouches_ = {model::deepest_crouch(robot, height.q.front(), options_.balanced.ahead_share),
               model::deepest_crouch(robot, height.q.front(), options_.unbalanced.ahead_share)};
}

void SitDown::start(std::int64_t now_ns) noexcept {
  stage_ = lowest_m_ < 0.0 ? Stage::kReference : Stage::kNone;
  start_ns_ = now_ns;
  unbalanced_ = false;
}

const JointVector& SitDown::same_torque(const JointVector& q, const JointVector& q_des,
                                        const JointVector& kp) noexcept {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    from_[i] = own_.kp_Nm_per_rad[i] > 0.0 ? q[i] + kp[i] * (q_des[i] - q[i]) / own_.kp_Nm_per_rad[i] : q_des[i];
  }
  return from_;
}

void SitDown::lower_joints(const JointVector& q, const JointVector& q_des, const JointVector& kp,
                           std::int64_t now_ns) noexcept {
  same_torque(q, q_des, kp);
  stage_ = Stage::kJoints;
  joints_start_ns_ = now_ns;
}

SitDown::Stage SitDown::stage(std::int64_t now_ns) noexcept {
  const bool lowered = stage_ == Stage::kReference || stage_ == Stage::kJoints;
  if (lowered && seconds(now_ns - start_ns_) > way().crouch_s + options_.settle_s - kRounding_s) {
    stage_ = Stage::kDamped;
  }
  return stage_;
}

bool SitDown::active(std::int64_t now_ns) noexcept {
  const Stage now = stage(now_ns);
  return now == Stage::kReference || now == Stage::kJoints;
}

bool SitDown::reference_is_due(std::int64_t now_ns) const noexcept {
  return seconds(now_ns - start_ns_) < way().reference_s - kRounding_s;
}

void SitDown::step(std::int64_t now_ns, model::JointCommand& command) const noexcept {
  const double whole_s = way().crouch_s - seconds(joints_start_ns_ - start_ns_);
  const double gone_s = seconds(now_ns - joints_start_ns_);
  command.q = from_ + share_of_way(gone_s < whole_s ? gone_s / whole_s : 1.0) * (crouch() - from_);
  command.dq.setZero();
  command.tau_ff.setZero();
  command.kp = own_.kp_Nm_per_rad;
  command.kd = own_.kd_Nm_s_per_rad;
}

}  // namespace pmg::control
