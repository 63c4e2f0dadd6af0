// The way to one motor's drive: its protocol, what is asked of it in a cycle, and what it answers. The bus thread, the
// roll call and whoever moves one motor alone go through it.
#pragma once

#include <memory>

#include "drives/motor_group.hpp"
#include "drives/motor_monitor.hpp"

namespace pmg::drives {

/// No heap after construction, no lock. A cycle: its monitor begins, ask() or ask_off(), answers into hear(),
/// follow_up().
class MotorChannel {
 public:
  /// Keeps references to setup, one motor of the bus, and to its monitor, whose cycle its owner begins. fd: the bus has
  /// CAN FD.
  MotorChannel(const MotorSetup& setup, MotorMonitor& monitor, bool fd);

  bool asked_by_sync() const noexcept { return protocol_->asked_by() == Protocol::AskedBy::kSync; }
  /// The bus is to have no SYNC in this cycle: what this drive sends all the same is late.
  bool pauses_sync() const noexcept { return asked_by_sync() && monitor_->pauses(); }

  struct Cycle {
    bool stiff = false;   ///< some motor of the robot is told a gain or a torque: no drive is switched on
    bool urgent = false;  ///< the robot's gains are others than in the cycle before: no drive waits for its command
    bool synced = false;  ///< SYNC goes out
  };
  /// wanted: at the joint, or at the crank. A drive that its messages ask gets none in a pause of its monitor unless
  /// the cycle is urgent.
  void ask(const MotorCommand& wanted, const Cycle& cycle, Outbox& out) noexcept;
  /// The drive is switched off and answers; it never waits.
  void ask_off(bool synced, Outbox& out) noexcept;
  /// What asked it, one of its messages or SYNC, never left this computer.
  void not_asked() noexcept;
  /// False: not this motor's.
  bool hear(const Message& message) noexcept;
  /// What the drive gets after its answers, computed from the newest of them.
  void follow_up(Outbox& out) noexcept;
  /// The bus thread paused for so long that the drive's watchdog may have acted. Some drives say so themselves.
  void interrupt() noexcept;
  /// The present position becomes the drive's zero. False: its protocol has no message for it.
  bool zero(Outbox& out) noexcept { return protocol_->zero(out); }

  const MotorSetup& setup() const noexcept { return *setup_; }
  const MotorMonitor& monitor() const noexcept { return *monitor_; }
  const Protocol& protocol() const noexcept { return *protocol_; }

 private:
  Freshness freshness() const noexcept;

  const MotorSetup* setup_;
  MotorMonitor* monitor_;
  std::unique_ptr<Protocol> protocol_;
  bool asked_ = false;  // in this cycle
};

}  // namespace pmg::drives
