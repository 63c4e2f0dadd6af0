// One drive as its frames show it: commands in, replies out, its own watchdog, faults on demand. The motor behind it is
// the caller's: it takes command() and gives the true reading.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "can/bus_setup.hpp"
#include "drives/message.hpp"

namespace pmg::test {

/// Frames that a drive sends to one that it heard, at most.
using Replies = std::array<drives::Message, 6>;

class DriveEmulator {
 public:
  /// Cycles of 2 ms without a frame after which an MIT drive lets go: 20 ms.
  static constexpr int kWatchdogCycles = 10;
  static constexpr double kBrake_Nm_s_per_rad = 2.0;  ///< of a watchdog, and of a quick stop
  static constexpr double kCool_degC = 35.0;

  explicit DriveEmulator(const drives::MotorSetup& setup) : node(setup.node), setup_(&setup) {}
  virtual ~DriveEmulator() = default;
  DriveEmulator(const DriveEmulator&) = delete;
  DriveEmulator& operator=(const DriveEmulator&) = delete;

  virtual int hear(const drives::Message& frame, Replies& replies) noexcept = 0;  ///< => how many replies
  virtual void tick() noexcept = 0;                                               ///< 2 ms pass
  /// What the motor is given: without torque while the drive is off; braked after its watchdog acted. The drive closes
  /// its loop on what its encoder shows, wherever the motor is: after its zero was set, or with a turn too many.
  drives::MotorCommand command() const noexcept {
    drives::MotorCommand given = told();
    given.q_rad += motor_.q_rad - shown().q_rad;
    return given;
  }
  virtual bool enabled() const noexcept = 0;
  virtual bool tripped() const noexcept = 0;  ///< its watchdog has acted

  /// The true motor, every 2 ms.
  void feel(const drives::MotorReading& motor) noexcept {
    motor_ = motor;
    turn_rad += drift_rad;
  }
  const drives::MotorSetup& setup() const noexcept { return *setup_; }
  double shown_rad() const noexcept { return shown().q_rad; }  ///< by its encoder

  int patience =
      1;  ///< its watchdog takes so many times its time: for a computer on which programs wait for each other

  // Faults on demand.
  bool silent = false;
  bool twice = false;                         ///< a second drive of this node number answers too
  std::optional<double> stuck_q;              ///< the encoder shows this for ever [rad]
  double turn_rad = 0.0;                      ///< added to the encoder: a wrapped or lost turn
  double drift_rad = 0.0;                     ///< by which the encoder's zero moves every 2 ms
  double speed_rad_s = 0.0, torque_Nm = 0.0;  ///< added to what the drive reads
  double temperature_degC = kCool_degC;
  drives::DriveFault fault = drives::DriveFault::kNone;
  bool fault_passed = false;  ///< its cause is gone: the message that clears faults clears it
  int node;                   ///< that it answers as; another than its own: a wrong id

  int heard = 0;   ///< frames that it answers: a command, or SYNC
  int obeyed = 0;  ///< commands of a CANopen drive

 protected:
  virtual drives::MotorCommand told() const noexcept = 0;  ///< in the encoder's angles
  drives::MotorReading shown() const noexcept {
    drives::MotorReading shown = motor_;
    shown.q_rad = stuck_q ? *stuck_q : shown.q_rad + turn_rad - zero_rad_;
    shown.dq_rad_s += speed_rad_s;
    shown.torque_Nm += torque_Nm;
    shown.temperature_degC = temperature_degC;
    shown.fault = fault;
    return shown;
  }
  void set_zero() noexcept { zero_rad_ += shown().q_rad; }

 private:
  const drives::MotorSetup* setup_;
  drives::MotorReading motor_;
  double zero_rad_ = 0.0;
};

}  // namespace pmg::test
