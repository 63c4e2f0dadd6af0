#include "drives/motor_monitor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pmg::drives {

const char* to_string(Trouble trouble) noexcept {
  constexpr std::array<const char*, 9> kTexts = {"answers",
                                                 "does not answer",
                                                 "reports a fault",
                                                 "is not enabled",
                                                 "its position jumped: a turn was lost",
                                                 "its encoder stands still while the motor turns",
                                                 "two drives have this node number",
                                                 "is told other gains than those of its drive's own loop",
                                                 "was powered anew and has lost its set-up: start the program anew"};
  return kTexts[static_cast<std::size_t>(trouble)];
}

void MotorMonitor::ask(bool enabling) noexcept {
  if (++cycles_since_overdue_ > kUncalledCycles) overdue_ = 0;
  if (owed_ == 2) {
    ++lost_;
    overdue_ = std::min(overdue_ + 1, kOverdue);
    cycles_since_overdue_ = 0;
  }
  owed_ = std::min(owed_ + 1, 2);
  age_ = std::min(age_ + 1, kNever);
  if (++cycles_since_uncalled_ > kUncalledCycles) uncalled_lately_ = 0;
  enabling_ = enabling;
  if (age_ > kSilentCycles) enabled_ = false;
}

bool MotorMonitor::hear(const MotorReading& reading) noexcept {
  if (owed_ == 0) {
    hear_stray();
    return false;
  }
  --owed_;
  if (!std::isfinite(reading.q_rad) || !std::isfinite(reading.dq_rad_s) || !std::isfinite(reading.torque_Nm) ||
      jumped(reading)) {
    ++refused_;
    if (++jumps_ >= kJumps) latched_ = Trouble::kPositionJump;
    return false;
  }
  jumps_ = 0;
  watch_encoder(reading);
  reading_ = reading;
  any_ = true;
  age_ = 0;
  if (reading.fault != DriveFault::kNone) {
    enabled_ = false;
  } else if (reading.follows != Follows::kUnknown) {
    enabled_ = reading.follows == Follows::kYes;
  } else if (enabling_) {
    enabled_ = true;
  }
  return true;
}

void MotorMonitor::hear_stray() noexcept {
  if (owed_ != 0) return;
  if (overdue_ > 0) {
    --overdue_;
    return;
  }
  ++uncalled_;
  cycles_since_uncalled_ = 0;
  if (++uncalled_lately_ >= kUncalled) latched_ = Trouble::kTwoOfOneNode;
}

bool MotorMonitor::jumped(const MotorReading& reading) const noexcept {
  if (!any_) return false;
  // An answer may belong to the command before: one period more.
  const double bound_rad = 2.0 * limits_.dq_rad_s * kPeriod_s * (age_ + 1) + kJumpMargin_rad;
  return std::abs(reading.q_rad - reading_.q_rad) > bound_rad;
}

void MotorMonitor::watch_encoder(const MotorReading& reading) noexcept {
  if (!any_ || reading.q_rad != reading_.q_rad) {
    frozen_travel_rad_ = 0.0;
    return;
  }
  if (std::abs(reading.dq_rad_s) > kSpeedOffset_rad_s)
    frozen_travel_rad_ += reading.dq_rad_s * kPeriod_s * std::max(age_, 1);
  if (std::abs(frozen_travel_rad_) > kFrozenTravel_rad) latched_ = Trouble::kFrozenEncoder;
}

Trouble MotorMonitor::trouble(bool stiff) const noexcept {
  if (latched_ != Trouble::kNone) return latched_;
  if (age_ > kSilentCycles) return Trouble::kSilent;
  if (reading_.fault != DriveFault::kNone) return Trouble::kFault;
  if (gains_refused_) return Trouble::kOtherGains;
  return stiff && !enabled_ ? Trouble::kNotEnabled : Trouble::kNone;
}

Condition MotorMonitor::condition(bool stiff) const noexcept {
  if (trouble(stiff) != Trouble::kNone) return Condition::kLost;
  return age_ > kFreshCycles ? Condition::kLate : Condition::kGood;
}

}  // namespace pmg::drives
