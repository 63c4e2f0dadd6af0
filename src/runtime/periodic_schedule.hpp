// When a periodic thread begins its cycles: times on a grid of one period. Plain arithmetic, so tests give the times.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pmg::runtime {

class PeriodicSchedule {
 public:
  constexpr PeriodicSchedule(std::int64_t first_ns, std::int64_t period_ns) noexcept
      : period_ns_(period_ns), planned_ns_(first_ns) {}

  constexpr std::int64_t planned_ns() const noexcept { return planned_ns_; }  ///< the next cycle
  constexpr std::int64_t missed() const noexcept { return missed_; }          ///< cycles left out since the start

  /// The grid moves, the next cycle with it.
  constexpr void shift(std::int64_t later_ns) noexcept { planned_ns_ += later_ns; }

  /// The planned cycle ran from woke_ns to done_ns. Its delay is max(woke - planned, done - (planned + period)).
  /// - Delay below half a period: the next cycle is the next of the grid. It begins at once if its time has come.
  /// - Longer (the host stalled, or the cycle took too long): the next cycle is the first of the grid that begins a
  ///   quarter of a period or more after done_ns. Cycles are not made up for: two ticks in a burst would see the same
  ///   old sample. A quarter of the control period (2.5 ms) lets the bus (2 ms) bring a new one.
  constexpr void advance(std::int64_t woke_ns, std::int64_t done_ns) noexcept {
    const std::int64_t delay_ns = std::max(woke_ns - planned_ns_, done_ns - (planned_ns_ + period_ns_));
    std::int64_t periods = 1;
    if (2 * delay_ns >= period_ns_) {
      const std::int64_t earliest_ns = done_ns + period_ns_ / 4;
      periods = (earliest_ns - planned_ns_ + period_ns_ - 1) / period_ns_;
    }
    missed_ += periods - 1;
    planned_ns_ += periods * period_ns_;
  }

 private:
  std::int64_t period_ns_, planned_ns_, missed_ = 0;
};

}  // namespace pmg::runtime
