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

/// No heap, no lock. A cycle: its monitor begins, ask() or ask_off(), answers into hear(), targets().
class BusMotor {
 public:
  /// Keeps references to setup, one motor of the bus, and to its monitor, whose cycle its owner begins.
  BusMotor(const drives::MotorSetup& setup, const drives::BusSetup& bus, drives::MotorMonitor& monitor) noexcept;

  /// The bus is to have no SYNC in this cycle: what a CANopen drive sends all the same is late.
  bool pauses_sync() const noexcept { return std::holds_alternative<Canopen>(drive_) && monitor_->pauses(); }
  struct Cycle {
    bool stiff = false;   ///< some motor of the robot is told a gain or a torque: no drive is switched on
    bool urgent = false;  ///< the robot's gains are others than in the cycle before: no drive waits for its command
    bool synced = false;  ///< SYNC goes out
  };
  /// wanted: at the joint, or at the crank. An MIT drive gets this frame and answers it; none in a pause of its monitor
  /// unless the cycle is urgent. A CANopen drive answers the bus's SYNC; one that is silent is started anew now and
  /// then: it may have left the state "operational".
  std::optional<Frame> ask(const drives::MotorCommand& wanted, const Cycle& cycle) noexcept;
  /// The drive is switched off and answers; it never waits.
  std::optional<Frame> ask_off(bool synced) noexcept;
  /// What asked it, the frame or SYNC, never left this computer.
  void not_asked() noexcept;
  /// False: not this motor's.
  bool hear(const Frame& frame) noexcept;
  /// What a frame says, whoever asked for it: of a drive that this program doesn't drive. A CANopen drive's frames come
  /// in pairs, and the second one is a reading.
  struct Heard {
    enum class What : std::uint8_t { kForeign, kNoted, kReading, kPart, kBootUp } what = What::kForeign;
    drives::MotorReading reading{};  ///< of kReading
  };
  Heard overhear(const Frame& frame) noexcept;
  /// The command of a CANopen drive, computed from the newest reading.
  std::optional<Frame> targets() noexcept;

  /// The bus thread paused for so long that the drive's watchdog may have acted. A CANopen drive says so itself.
  void interrupt() noexcept;

  const drives::MotorSetup& setup() const noexcept { return *setup_; }
  const drives::MotorMonitor& monitor() const noexcept { return *monitor_; }
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
  Heard overhear(Canopen& drive, const Frame& frame) const noexcept;
  drives::Freshness freshness() const noexcept;

  const drives::MotorSetup* setup_;
  std::variant<Mit, Canopen> drive_;
  drives::MotorMonitor* monitor_;
  bool asked_ = false;  // in this cycle
};

/// For a monitor of one of its motors: see drives::MotorMonitor.
int fresh_cycles(const drives::BusSetup& bus) noexcept;

/// The identifiers with which the drives of a bus, and its IMU, send to this computer: a receive filter. Allocates.
std::vector<std::uint32_t> awaited_ids(const drives::BusSetup& bus);

/// The node of a drive that the bus isn't to have, if it sent this frame: a reply with an identifier of the bus's MIT
/// drives, or one of a CANopen drive's messages of the cycle.
std::optional<int> stranger(const drives::BusSetup& bus, const Frame& frame) noexcept;
std::optional<int> mit_stranger(const drives::BusSetup& bus, const Frame& frame) noexcept;

}  // namespace pmg::can
