// One cycle of the 500 Hz bus thread: newest command, guard, exchange with the drives, news for the control thread. The
// same object runs in lockstep and in the robot's bus thread.
#pragma once

#include "hal/command_guard.hpp"
#include "hal/hal.hpp"
#include "hal/stop_line.hpp"
#include "io/clock.hpp"
#include "io/mailbox.hpp"

namespace pmg::hal {

/// The bus thread's message to the control thread, in every cycle.
struct BusSample {
  model::RobotState state;  ///< of the last cycle in which the drives answered
  BusStatus status = BusStatus::kOk;
  std::uint32_t trips = 0;  ///< the guard's interventions so far
  TripCause trip_cause = TripCause::kNone;
};

/// The mailboxes between the bus and the control thread.
struct BusLink {
  io::Mailbox<ControlOutput> commands;
  io::Mailbox<BusSample> samples;
  StopLine stop;
};

class BusCycle {
 public:
  static constexpr std::int64_t kPeriod_ns = 2'000'000;

  /// Keeps references to hal, link and clock.
  BusCycle(Hal& hal, BusLink& link, const model::RobotModel& robot, const io::Clock& clock,
           const GuardOptions& options = {});

  /// (newest ControlOutput, stop line) => (drives, BusSample): guard, exchange, stamp. No exception, heap, lock or I/O
  /// but the exchange itself.
  void run() noexcept;

  const BusSample& sample() const noexcept { return sample_; }
  const model::JointCommand& sent() const noexcept { return *sent_; }  ///< what the drives were given last
  const CommandGuard& guard() const noexcept { return guard_; }

 private:
  Hal& hal_;
  BusLink& link_;
  const io::Clock& clock_;
  CommandGuard guard_;
  ControlOutput incoming_;
  BusSample sample_;
  const model::JointCommand* sent_;
};

}  // namespace pmg::hal
