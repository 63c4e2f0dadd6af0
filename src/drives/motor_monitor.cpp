#include "drives/motor_monitor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pmg::drives {

const char* to_string(Trouble trouble) noexcept {
  constexpr std::array<const char*, 10> kTexts = {
      "answers",
      "does not answer",
      "reports a fault",
      "is not enabled",
      "its position jumped: a turn was lost",
      "its encoder stands still while the motor turns",
      "two drives have this node number",
      "is told other gains than those of its drive's own loop",
      "was powered anew and has lost its set-up: start the program anew",
      "answers, but each time with an old state: something holds its bus up"};
  return kTexts[static_cast<std::size_t>(trouble)];
}

void MotorMonitor::begin() noexcept {
  old_cycles_ = any_ && !fresh() && !silent() ? old_cycles_ + 1 : 0;
  age_ = std::min(age_ + 1, kNever);
  silence_ = std::min(silence_ + 1, kNever);
  if (silent()) enabled_ = false;
  if (++cycles_since_uncalled_ > kUncalledCycles) {
    if (two()) {  // the second drive is gone; which of the two said what isn't known
      any_ = false;
      if (latched_ != Trouble::kRestarted) latched_ = Trouble::kNone;
    }
    uncalled_lately_ = 0;
  }
  const int given_up = ledger_.begin();
  if (given_up == 0) return;
  lost_ += static_cast<std::uint32_t>(given_up);
  enabled_after_ = 0;
}

void MotorMonitor::ask(bool enabling) noexcept {
  ledger_.ask();
  if (enabling && enabled_after_ == 0) enabled_after_ = ledger_.owed();
}

void MotorMonitor::take_back() noexcept {
  ledger_.take_back();
  if (enabled_after_ > ledger_.owed()) enabled_after_ = 0;
}

bool MotorMonitor::hear(const MotorReading& reading) noexcept {
  const AnswerLedger::Belongs belongs = ledger_.hear();
  take(belongs);
  if (belongs != AnswerLedger::Belongs::kToARequest) return false;
  const bool to_enabling = enabled_after_ == 1;
  enabled_after_ = std::max(enabled_after_ - 1, 0);
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
  age_ = ledger_.age_cycles();
  silence_ = 0;
  if (reading.fault != DriveFault::kNone) {
    enabled_ = false;
  } else if (reading.follows != Follows::kUnknown) {
    enabled_ = reading.follows == Follows::kYes;
  } else if (to_enabling) {
    enabled_ = true;
  }
  return true;
}

void MotorMonitor::hear_stray() noexcept { take(ledger_.hear_part()); }

void MotorMonitor::take(AnswerLedger::Belongs belongs) noexcept {
  if (belongs != AnswerLedger::Belongs::kToNone) return;
  ++uncalled_;
  ++uncalled_lately_;
  cycles_since_uncalled_ = 0;
}

void MotorMonitor::interrupt() noexcept {
  enabled_ = false;
  enabled_after_ = 0;
}

bool MotorMonitor::jumped(const MotorReading& reading) const noexcept {
  if (!any_) return false;
  // An answer may belong to the command before: one period more.
  const double t_s = kPeriod_s * (silence_ + 1);
  const double most_rad = 2.0 * limits_.dq_rad_s * t_s + kJumpMargin_rad;
  const double slack_rad = 0.25 * kMostAcceleration_rad_s2 * t_s * t_s + kJumpMargin_rad;
  const auto [slower, faster] = std::minmax({0.0, reading_.dq_rad_s, reading.dq_rad_s});
  const double up_rad = std::min(kSpeedShare * faster * t_s + slack_rad, most_rad);
  const double down_rad = std::min(-kSpeedShare * slower * t_s + slack_rad, most_rad);
  const double moved_rad = reading.q_rad - reading_.q_rad;
  return moved_rad > up_rad || moved_rad < -down_rad;
}

void MotorMonitor::watch_encoder(const MotorReading& reading) noexcept {
  if (!any_ || reading.q_rad != reading_.q_rad) {
    frozen_travel_rad_ = 0.0;
    return;
  }
  if (std::abs(reading.dq_rad_s) > kSpeedOffset_rad_s)
    frozen_travel_rad_ += reading.dq_rad_s * kPeriod_s * std::max(silence_, 1);
  if (std::abs(frozen_travel_rad_) > kFrozenTravel_rad) latched_ = Trouble::kFrozenEncoder;
}

Trouble MotorMonitor::trouble(bool stiff) const noexcept {
  if (two()) return Trouble::kTwoOfOneNode;  // first: the others may come of it
  if (latched_ != Trouble::kNone) return latched_;
  if (silent()) return Trouble::kSilent;
  if (reading_.fault != DriveFault::kNone) return Trouble::kFault;
  if (gains_refused_) return Trouble::kOtherGains;
  if (old_cycles_ >= kOldCycles && !fresh()) return Trouble::kOldState;
  return stiff && !enabled_ ? Trouble::kNotEnabled : Trouble::kNone;
}

Condition MotorMonitor::condition(bool stiff) const noexcept {
  if (trouble(stiff) != Trouble::kNone) return Condition::kLost;
  return fresh() ? Condition::kGood : Condition::kLate;
}

}  // namespace pmg::drives
