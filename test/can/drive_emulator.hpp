// One MIT drive as its frames show it: command in, reply out, its own watchdog, faults on demand. The motor behind it
// is the caller's: it takes command() and gives the true reading.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "can/can_hal.hpp"
#include "drives/drive_setup.hpp"
#include "drives/mit_protocol.hpp"

namespace pmg::test {

class DriveEmulator {
 public:
  /// Cycles of 2 ms without a frame after which the drive lets go: 20 ms.
  static constexpr int kWatchdogCycles = 10;

  explicit DriveEmulator(const drives::MotorSetup& setup) : setup_(&setup), protocol_(setup.ranges), node(setup.node) {}

  /// A frame to this drive => its replies.
  int hear(const can::Frame& frame, std::array<can::Frame, 2>& replies) noexcept {
    if (silent || frame.extended || frame.id != static_cast<std::uint32_t>(setup_->node) || frame.length != 8) return 0;
    silent_cycles_ = 0;
    ++heard;
    drives::MitFrame bytes{};
    std::copy_n(frame.data.begin(), 8, bytes.begin());
    if (bytes == drives::kMitEnable) {
      enabled_ = fault == drives::DriveFault::kNone;
      tripped_ = false;
      command_ = {};
    } else if (bytes == drives::kMitDisable) {
      enabled_ = false;
    } else if (bytes == drives::kMitZero) {
      zero_rad_ += reading().q_rad;
    } else if (enabled_) {
      command_ = *protocol_.command(bytes);
    }
    replies[0] = can::Frame::of(can::kReplyId, protocol_.reply({static_cast<std::uint8_t>(node), reading()}), frame.fd);
    if (!twice) return 1;
    drives::MotorReading second = reading();
    second.q_rad += 0.01;
    replies[1] = can::Frame::of(can::kReplyId, protocol_.reply({static_cast<std::uint8_t>(node), second}), frame.fd);
    return 2;
  }

  /// 2 ms pass.
  void tick() noexcept {
    if (++silent_cycles_ <= kWatchdogCycles || !enabled_) return;
    enabled_ = false;
    tripped_ = true;
  }

  /// What the motor is given: without torque while the drive is off; braked after its watchdog acted.
  drives::MotorCommand command() const noexcept {
    if (tripped_) return {.kd_Nm_s_per_rad = kBrake_Nm_s_per_rad};
    return enabled_ && fault == drives::DriveFault::kNone ? command_ : drives::MotorCommand{};
  }
  void feel(const drives::MotorReading& motor) noexcept { motor_ = motor; }  ///< the true motor

  bool enabled() const noexcept { return enabled_; }
  bool tripped() const noexcept { return tripped_; }
  const drives::MotorSetup& setup() const noexcept { return *setup_; }

  // Faults on demand.
  bool silent = false;
  bool twice = false;             ///< a second drive of this node number answers too
  std::optional<double> stuck_q;  ///< the encoder shows this for ever [rad]
  double turn_rad = 0.0;          ///< added to the encoder: a wrapped or lost turn
  double temperature_degC = 35.0;
  drives::DriveFault fault = drives::DriveFault::kNone;
  int heard = 0;

 private:
  static constexpr double kBrake_Nm_s_per_rad = 2.0;
  drives::MotorReading reading() const noexcept {
    drives::MotorReading shown = motor_;
    shown.q_rad = stuck_q ? *stuck_q : shown.q_rad + turn_rad - zero_rad_;
    shown.temperature_degC = temperature_degC;
    shown.fault = fault;
    return shown;
  }

  const drives::MotorSetup* setup_;
  drives::MitProtocol protocol_;
  drives::MotorReading motor_;
  drives::MotorCommand command_;
  bool enabled_ = false, tripped_ = false;
  int silent_cycles_ = 0;
  double zero_rad_ = 0.0;

 public:
  int node;  ///< that it answers as; another than its own: a wrong id
};

}  // namespace pmg::test
