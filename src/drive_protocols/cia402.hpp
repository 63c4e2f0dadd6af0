// Drives of the profile CiA 402 (IEC 61800-7-201): the state machine behind status word and control word, units, fault
// codes, and what one cycle tells the drive. Nothing here knows a bus: CANopen and EtherCAT carry the same objects.
#pragma once

#include <cstdint>
#include <numbers>

#include "drives/motor.hpp"
#include "drives/protocol.hpp"

namespace pmg::drives {

enum class Cia402Mode : std::int8_t {  // values of object 0x6060
  kPosition = 8,                       ///< cyclic synchronous position: the drive closes the loop with its own gains
  kTorque = 10,                        ///< cyclic synchronous torque: the bus thread closes the loop
};

/// A drive as robot.yaml has it. Its output shaft is the one that its position counts.
struct Cia402Settings {
  Cia402Mode mode = Cia402Mode::kTorque;
  double counts_per_turn = 0.0;      ///< of the position (0x6064, 0x607A); 0x608F gives the same
  double velocity_unit_rad_s = 0.0;  ///< of one count of the velocity (0x606C)
  double rated_torque_Nm = 0.0;      ///< 1000 counts of torque (0x6071, 0x6077); 0x6076 gives the same
  double largest_torque_Nm = 0.0;    ///< that the drive gives at most; 0x6072 is set to the joint's share of it
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;  ///< of the drive's own loop; position mode only
  std::uint32_t vendor_id = 0, product_code = 0;      ///< 0x1018; 0: any
  std::uint16_t temperature_index = 0;                ///< a manufacturer's object of 16 bits; 0: none
  std::uint8_t temperature_subindex = 0;
  double temperature_unit_degC = 1.0;

  double count_rad() const noexcept { return 2.0 * std::numbers::pi / counts_per_turn; }
};

enum class Cia402State : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

Cia402State cia402_state(std::uint16_t status_word) noexcept;
/// The fault behind an error code (0x603F or an emergency message; CiA 301 table of error codes, CiA 402-2 annex).
/// 0 is no fault.
DriveFault cia402_fault(std::uint16_t error_code) noexcept;

/// What the drive sends in each cycle.
struct Cia402Inputs {
  std::uint16_t status_word = 0;
  std::int32_t position = 0;     ///< [counts]
  std::int32_t velocity = 0;     ///< [velocity_unit_rad_s]
  std::int16_t torque = 0;       ///< [0.001 rated torque]
  std::int16_t temperature = 0;  ///< [temperature_unit_degC]
  std::uint16_t error_code = 0;
};

/// What it gets in each cycle.
struct Cia402Targets {
  std::uint16_t control_word = 0;
  std::int32_t position = 0;  ///< [counts]
  std::int16_t torque = 0;    ///< [0.001 rated torque]
};

/// One drive's way through the state machine. No heap, no lock.
class Cia402Axis {
 public:
  /// A drive in position mode is switched on by a stiff command. It has so many cycles to do so: 0.1 s, in which most
  /// holding brakes open (assumption).
  static constexpr int kSwitchOnCycles = 50;
  /// Between two resets of a fault that stays: 0.5 s.
  static constexpr int kResetCycles = 250;
  /// A joint may lie on its stop by so much and is switched on all the same.
  static constexpr double kBeyondRange_rad = 0.2;
  /// Gains differ when they differ by more: robot.yaml's digits and a gear's rounding are less.
  static constexpr double kSameGains = 1e-3;

  Cia402Axis(const Cia402Settings& settings, const MotorLimits& limits) noexcept
      : settings_(settings), limits_(limits) {}

  /// (what the drive sent) => (reading). `follows` says whether the drive does what the last command asked.
  MotorReading hear(const Cia402Inputs& inputs) noexcept;

  /// (command, newest believed reading) => (targets), once a cycle.
  /// stiff: some motor of the robot is told a gain or a torque. A drive is switched on only after a cycle that was not:
  /// it never jumps.
  /// - Torque mode: torque = kp (q - q_measured) + kd (dq - dq_measured) + feed-forward from a fresh reading, -kd
  ///   dq_measured from a late one, and nothing without one.
  /// - Position mode: kp = kd = 0 switches the motor's voltage off, kp = 0 with kd is a quick stop, and the drive's own
  ///   gains without feed-forward move it. Anything else is refused() and a quick stop.
  /// Targets stay within limits whatever the arguments are; not a number counts as no command.
  Cia402Targets command(const MotorCommand& command, bool stiff, const MotorReading& measured,
                        Freshness freshness) noexcept;

  bool refused() const noexcept { return refused_; }  ///< the last command has gains that the drive hasn't
  const Cia402Settings& settings() const noexcept { return settings_; }

 private:
  enum class Wish : std::uint8_t { kOff, kQuickStop, kReady, kOn };
  bool on() const noexcept { return state_ == Cia402State::kOperationEnabled; }
  bool faulty() const noexcept { return state_ == Cia402State::kFault || state_ == Cia402State::kFaultReactionActive; }
  void arm(bool stiff, const MotorReading& measured, Freshness freshness) noexcept;
  std::uint16_t control_word(Wish wish, bool stiff) noexcept;
  Cia402Targets torque_mode(const MotorCommand& command, bool stiff, const MotorReading& measured,
                            Freshness freshness) noexcept;
  Cia402Targets position_mode(const MotorCommand& command, bool stiff, const MotorReading& measured,
                              Freshness freshness) noexcept;
  std::int32_t position_count(double q_rad) const noexcept;
  std::int16_t torque_count(double torque_Nm) const noexcept;

  Cia402Settings settings_;
  MotorLimits limits_;
  Cia402State state_ = Cia402State::kNotReady;
  bool refused_ = false;
  bool armed_ = false;   // a cycle without stiffness found the drive sound: it may be on
  bool moves_ = false;   // position mode: the last command was a motion
  bool was_on_ = false;  // position mode: it was on since that motion began
  int switching_ = 0;    // position mode: cycles since the motion was asked for
  int since_reset_ = kResetCycles;
  double target_rad_ = 0.0;
};

}  // namespace pmg::drives
