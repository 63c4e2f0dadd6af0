#include "drive_protocols/cia402.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::drives {

namespace {

// Control words of the transitions (CiA 402-2, device control commands).
constexpr std::uint16_t kDisableVoltage = 0x0000, kQuickStopWord = 0x0002, kShutdown = 0x0006, kSwitchOn = 0x0007,
                        kEnableOperation = 0x000F, kFaultReset = 0x0080;
constexpr double kCycle_s = 0.002;
constexpr double kPerMille = 1e-3;

bool same(double asked, double own) noexcept { return std::abs(asked - own) <= Cia402Axis::kSameGains * own; }

/// The whole number nearest to value within [least, most]; if there is none, the one nearest to their middle.
template <typename Count>
Count nearest(double value, double least, double most) noexcept {
  constexpr double kLeast = std::numeric_limits<Count>::min(), kMost = std::numeric_limits<Count>::max();
  const double first = std::clamp(std::ceil(least), kLeast, kMost), last = std::clamp(std::floor(most), kLeast, kMost);
  if (!(first <= last) || std::isnan(value))
    return static_cast<Count>(std::clamp(std::round(0.5 * (least + most)), kLeast, kMost));
  return static_cast<Count>(std::clamp(std::round(value), first, last));
}

}  // namespace

Cia402State cia402_state(std::uint16_t status_word) noexcept {
  switch (status_word & 0x4FU) {  // without the bit "quick stop"
    case 0x00:
      return Cia402State::kNotReady;
    case 0x40:
      return Cia402State::kSwitchOnDisabled;
    case 0x0F:
      return Cia402State::kFaultReactionActive;
    case 0x08:
      return Cia402State::kFault;
    default:
      break;
  }
  switch (status_word & 0x6FU) {
    case 0x21:
      return Cia402State::kReadyToSwitchOn;
    case 0x23:
      return Cia402State::kSwitchedOn;
    case 0x27:
      return Cia402State::kOperationEnabled;
    case 0x07:
      return Cia402State::kQuickStopActive;
    default:
      return (status_word & 0x08U) != 0 ? Cia402State::kFault : Cia402State::kNotReady;
  }
}

DriveFault cia402_fault(std::uint16_t code) noexcept {
  if (code == 0) return DriveFault::kNone;
  const unsigned family = code >> 8U, kind = (code >> 4U) & 0xFU;
  if (code >> 12U == 0x2) return DriveFault::kOverCurrent;
  if (code >> 12U == 0x3 && kind == 1) return DriveFault::kOverVoltage;
  if (code >> 12U == 0x3 && kind == 2) return DriveFault::kUnderVoltage;
  if (family == 0x42 && kind == 1) return DriveFault::kBridgeTemperature;
  if (family == 0x43 && kind == 1) return DriveFault::kOverTemperature;
  if (code == 0x7121) return DriveFault::kStall;
  if (family == 0x73) return DriveFault::kEncoder;
  if (family == 0x81 || family == 0x82) return DriveFault::kCommunication;
  if (code == 0x8611) return DriveFault::kFollowing;
  return DriveFault::kOther;
}

MotorReading Cia402Axis::hear(const Cia402Inputs& inputs) noexcept {
  state_ = cia402_state(inputs.status_word);
  MotorReading reading{.q_rad = inputs.position * settings_.count_rad(),
                       .dq_rad_s = inputs.velocity * settings_.velocity_unit_rad_s,
                       .torque_Nm = inputs.torque * kPerMille * settings_.rated_torque_Nm,
                       .temperature_degC = inputs.temperature * settings_.temperature_unit_degC};
  if (state_ == Cia402State::kFault || state_ == Cia402State::kFaultReactionActive) {
    reading.fault = inputs.error_code != 0 ? cia402_fault(inputs.error_code) : DriveFault::kOther;
    armed_ = false;
  }
  // In position mode a motor that is off does what a command without kp asks. One that is being switched on has its
  // time.
  const bool waits = settings_.mode == Cia402Mode::kPosition && (!moves_ || !was_on_);
  const bool follows = armed_ && (on() || waits);
  reading.follows = follows ? Follows::kYes : Follows::kNo;
  return reading;
}

Cia402Targets Cia402Axis::command(const MotorCommand& asked, bool stiff, const MotorReading& measured,
                                  Freshness freshness) noexcept {
  const MotorCommand wanted = finite(asked) ? asked : MotorCommand{};
  since_reset_ = std::min(since_reset_ + 1, kResetCycles);
  arm(stiff, measured, freshness);
  return settings_.mode == Cia402Mode::kTorque ? torque_mode(wanted, stiff, measured, freshness)
                                               : position_mode(wanted, stiff, measured, freshness);
}

void Cia402Axis::arm(bool stiff, const MotorReading& measured, Freshness freshness) noexcept {
  const bool in_range = measured.q_rad >= limits_.q_lower_rad - kBeyondRange_rad &&
                        measured.q_rad <= limits_.q_upper_rad + kBeyondRange_rad;
  if (freshness == Freshness::kNone || faulty()) {
    armed_ = false;
  } else if (!stiff && (in_range || settings_.mode == Cia402Mode::kTorque)) {
    armed_ = true;
  }
}

// (state, wish) => (control word): one transition a cycle.
std::uint16_t Cia402Axis::control_word(Wish wish, bool stiff) noexcept {
  const bool up = wish == Wish::kOn || wish == Wish::kReady;
  switch (state_) {
    case Cia402State::kFault:
      if (stiff || since_reset_ < kResetCycles) return kDisableVoltage;
      since_reset_ = 0;
      return kFaultReset;  // its rising edge counts
    case Cia402State::kNotReady:
    case Cia402State::kFaultReactionActive:
      return kDisableVoltage;
    case Cia402State::kQuickStopActive:
      return wish == Wish::kQuickStop ? kQuickStopWord : kDisableVoltage;
    case Cia402State::kSwitchOnDisabled:
      return up ? kShutdown : kDisableVoltage;
    case Cia402State::kReadyToSwitchOn:
      return up ? kSwitchOn : kDisableVoltage;
    case Cia402State::kSwitchedOn:
      if (!up) return kDisableVoltage;
      return wish == Wish::kOn ? kEnableOperation : kSwitchOn;
    case Cia402State::kOperationEnabled:
      if (wish == Wish::kQuickStop) return kQuickStopWord;
      if (!up) return kDisableVoltage;
      return wish == Wish::kOn ? kEnableOperation : kSwitchOn;
  }
  return kDisableVoltage;
}

Cia402Targets Cia402Axis::torque_mode(const MotorCommand& command, bool stiff, const MotorReading& measured,
                                      Freshness freshness) noexcept {
  Wish wish = armed_ && (on() || !stiff) ? Wish::kOn : Wish::kOff;
  if (freshness == Freshness::kNone) wish = Wish::kQuickStop;
  Cia402Targets targets{
      .control_word = control_word(wish, stiff), .position = position_count(measured.q_rad), .torque = 0};
  if (wish != Wish::kOn || !on()) return targets;
  const double kp = std::max(command.kp_Nm_per_rad, 0.0), kd = std::max(command.kd_Nm_s_per_rad, 0.0);
  const double q_rad = std::clamp(command.q_rad, limits_.q_lower_rad, limits_.q_upper_rad);
  const double dq_rad_s = std::clamp(command.dq_rad_s, -limits_.dq_rad_s, limits_.dq_rad_s);
  const double pd_Nm = kp * (q_rad - measured.q_rad) + kd * (dq_rad_s - measured.dq_rad_s) + command.torque_Nm;
  targets.torque = torque_count(freshness == Freshness::kFresh ? pd_Nm : -kd * measured.dq_rad_s);
  return targets;
}

Cia402Targets Cia402Axis::position_mode(const MotorCommand& command, bool stiff, const MotorReading& measured,
                                        Freshness freshness) noexcept {
  moves_ = command.kp_Nm_per_rad != 0.0 || command.torque_Nm != 0.0;
  refused_ = moves_ && !(same(command.kp_Nm_per_rad, settings_.kp_Nm_per_rad) &&
                         same(command.kd_Nm_s_per_rad, settings_.kd_Nm_s_per_rad) && command.torque_Nm == 0.0);
  const bool went_off = was_on_ && !on();  // by itself
  switching_ = moves_ && !on() ? std::min(switching_ + 1, kSwitchOnCycles + 1) : 0;
  if (moves_ && (went_off || switching_ > kSwitchOnCycles)) armed_ = false;
  was_on_ = moves_ && (was_on_ || on());

  Wish wish = armed_ ? Wish::kReady : Wish::kOff;
  if (refused_ || freshness == Freshness::kNone) {
    wish = Wish::kQuickStop;
  } else if (moves_ && armed_) {
    wish = Wish::kOn;
  } else if (!moves_ && command.kd_Nm_s_per_rad != 0.0 && (on() || state_ == Cia402State::kQuickStopActive)) {
    wish = Wish::kQuickStop;
  }
  // A target begins where the motor is and moves no faster than the motor may.
  if (!on() || !moves_) target_rad_ = measured.q_rad;
  if (on() && wish == Wish::kOn && freshness == Freshness::kFresh) {
    const double step_rad = limits_.dq_rad_s * kCycle_s;
    target_rad_ += std::clamp(command.q_rad - target_rad_, -step_rad, step_rad);
  }
  target_rad_ = std::clamp(target_rad_, limits_.q_lower_rad, limits_.q_upper_rad);
  return {.control_word = control_word(wish, stiff), .position = position_count(target_rad_), .torque = 0};
}

std::int32_t Cia402Axis::position_count(double q_rad) const noexcept {
  const double turn = 1.0 / settings_.count_rad();
  return nearest<std::int32_t>(q_rad * turn, limits_.q_lower_rad * turn, limits_.q_upper_rad * turn);
}

std::int16_t Cia402Axis::torque_count(double torque_Nm) const noexcept {
  const double count_Nm = kPerMille * settings_.rated_torque_Nm;
  if (std::isnan(torque_Nm)) return 0;
  return nearest<std::int16_t>(torque_Nm / count_Nm, -limits_.torque_Nm / count_Nm, limits_.torque_Nm / count_Nm);
}

}  // namespace pmg::drives
