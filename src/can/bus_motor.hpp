// One motor's drive on a CAN bus, whichever protocol it speaks: the frames of a cycle, and what they say.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "can/canopen.hpp"
#include "can/frame.hpp"
#include "drives/drive_setup.hpp"
#include "drives/motor_monitor.hpp"

namespace pmg::can {

/// No heap, no lock. A cycle: begin(), answers into hear(), targets().
class BusMotor {
 public:
  /// Keeps a reference to setup. fd: an MIT drive's frames are CAN FD's.
  BusMotor(const drives::MotorSetup& setup, bool fd) noexcept;

  /// A cycle begins. wanted: at the joint, or at the crank. stiff: some motor of the robot is told a gain or a torque;
  /// no drive is switched on in such a cycle. An MIT drive gets this frame and answers it. A CANopen drive answers the
  /// bus's SYNC; one that is silent is started anew now and then: it may have left the state "operational".
  std::optional<Frame> begin(const drives::MotorCommand& wanted, bool stiff) noexcept;
  /// A cycle begins in which the drive is switched off and answers.
  std::optional<Frame> begin_off() noexcept;
  /// False: not this motor's.
  bool hear(const Frame& frame) noexcept;
  /// The command of a CANopen drive, computed from the newest reading.
  std::optional<Frame> targets() noexcept;

  /// The bus thread paused for so long that the drive's watchdog may have acted. A CANopen drive says so itself.
  void interrupt() noexcept;

  const drives::MotorSetup& setup() const noexcept { return *setup_; }
  const drives::MotorMonitor& monitor() const noexcept { return monitor_; }
  double torque_step_Nm() const noexcept;    ///< of its torque reading
  std::uint16_t emergency() const noexcept;  ///< error code of the last emergency message; 0: none, or it is over

 private:
  struct Mit {
    drives::MitProtocol protocol;
    std::uint32_t reply_id;
    bool fd;
    double left_Nm = 0.0;  // of the last command's torque, for the next one
  };
  struct Canopen {
    drives::Cia402Axis axis;
    drives::Cia402Inputs inputs{};
    drives::MotorCommand wanted{};  // at the motor
    bool stiff = false, off = false;
    bool half = false;  // TPDO1 came, its TPDO2 not yet
    std::uint16_t emergency = 0;
    int since_start = 0;  // cycles
  };
  bool hear(Canopen& drive, const Frame& frame) noexcept;
  drives::Freshness freshness() const noexcept;

  const drives::MotorSetup* setup_;
  std::variant<Mit, Canopen> drive_;
  drives::MotorMonitor monitor_;
};

/// The identifiers with which the drives of a bus, and its IMU, send to this computer: a receive filter. Allocates.
std::vector<std::uint32_t> awaited_ids(const drives::BusSetup& bus);

/// The node that sent this frame, if it is one of the cycle's messages.
std::optional<int> sender(const Frame& frame) noexcept;

/// What a bus with CANopen drives carries in each cycle besides: SYNC, then a heartbeat where it is due. Returns how
/// many.
std::size_t network_frames(int cycle, std::span<Frame, 2> frames) noexcept;

}  // namespace pmg::can
