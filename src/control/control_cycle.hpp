// One cycle of the 100 Hz control thread: newest bus sample and operators' messages -> tick -> command for the bus, and
// a record of it all. The same object runs in lockstep and in the robot's control thread.
#pragma once

#include "control/operator_inbox.hpp"
#include "control/tick.hpp"
#include "control/tick_record.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"

namespace pmg::control {

class ControlCycle {
 public:
  static constexpr std::int64_t kPeriod_ns = 10'000'000;
  static constexpr double kPeriod_s = static_cast<double>(kPeriod_ns) * 1e-9;
  static constexpr int kBusCycles = static_cast<int>(kPeriod_ns / hal::BusCycle::kPeriod_ns);  ///< during one tick
  static_assert(kBusCycles * hal::BusCycle::kPeriod_ns == kPeriod_ns);

  /// Keeps references to all of them.
  ControlCycle(Tick& tick, hal::BusLink& link, OperatorInbox& inbox, const io::Clock& clock);

  /// No exception, heap, lock or I/O but the policy's own. planned_ns: when, by the clock, this cycle should have
  /// begun.
  void run(std::int64_t planned_ns) noexcept;

  const TickRecord& record() const noexcept { return record_; }  ///< of the last run, timing apart

 private:
  void take_sample() noexcept;
  void take_messages() noexcept;

  Tick& tick_;
  hal::BusLink& link_;
  OperatorInbox& inbox_;
  const io::Clock& clock_;
  hal::BusSample sample_;
  hal::ControlOutput output_;
  TickRecord record_;
  std::int64_t next_tick_ = 0;
  std::int64_t late_ns_ = 0;  // what this tick tells the next
};

}  // namespace pmg::control
