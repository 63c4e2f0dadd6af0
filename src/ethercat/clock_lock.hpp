// Keeps the bus thread's cycles at one phase of the slaves' distributed clock.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pmg::ethercat {

/// A loop of first order with an integrator for the clocks' different rates:
///   e = (phase - wanted) wrapped to +- period / 2, at most kMostError;  shift = -(kp e + sum of ki e).
/// Crystals differ by 100 ppm: 200 ns a cycle of 2 ms. A thread that wakes late sees its lateness as phase, so single
/// errors count little. Plain arithmetic.
class ClockLock {
 public:
  /// The largest shift a cycle: 1 % of the period, which no control loop here notices.
  static constexpr std::int64_t kMostShift_ns = 20'000;
  /// The integrator's bound [ns a cycle]: 500 ppm, no crystal is so far off.
  static constexpr double kMostDrift_ns = 1'000.0;
  /// Clocks that differ by more than 500 ppm in two spans of 1 s in a row: the slaves' clock runs away. The loop alone
  /// doesn't show this, as its phase goes round and round.
  static constexpr int kSpanCycles = 500;

  constexpr ClockLock(std::int64_t period_ns, std::int64_t wanted_ns) noexcept
      : period_ns_(period_ns), wanted_ns_(wanted_ns) {}

  /// (the slaves' time when the cycle's frame passed the reference clock, the host's time when it was sent) => how much
  /// later than planned the next cycle begins, and all after it [ns].
  constexpr std::int64_t update(std::int64_t slaves_ns, std::int64_t host_ns) noexcept {
    compare(slaves_ns, host_ns);
    error_ns_ = wrap(slaves_ns - wanted_ns_);
    const auto counted = static_cast<double>(std::clamp(error_ns_, -kMostError_ns, kMostError_ns));
    drift_ns_ = std::clamp(drift_ns_ - kIntegral * counted, -kMostDrift_ns, kMostDrift_ns);
    const auto shift = static_cast<std::int64_t>(drift_ns_ - kProportional * counted);
    return std::clamp(shift, -kMostShift_ns, kMostShift_ns);
  }
  constexpr std::int64_t error_ns() const noexcept { return error_ns_; }  ///< of the last cycle
  /// How much the host's period of 2 ms is too short by the slaves' clock [ns a cycle].
  constexpr double drift_ns() const noexcept { return drift_ns_; }
  constexpr bool runs_away() const noexcept { return fast_spans_ >= 2; }

 private:
  static constexpr std::int64_t kMostError_ns = 100'000;
  // Damping 0.7 at a natural frequency of 0.01 a cycle: settles within some 500 cycles, 1 s.
  static constexpr double kProportional = 0.014, kIntegral = 1e-4;

  constexpr std::int64_t wrap(std::int64_t ns) const noexcept {
    const std::int64_t rest = (ns % period_ns_ + period_ns_) % period_ns_;
    return rest >= period_ns_ / 2 ? rest - period_ns_ : rest;
  }

  constexpr void compare(std::int64_t slaves_ns, std::int64_t host_ns) noexcept {
    if (cycles_++ % kSpanCycles != 0) return;
    if (cycles_ > 1) {
      const auto off_ns = static_cast<double>((slaves_ns - span_slaves_ns_) - (host_ns - span_host_ns_));
      const double most_ns =
          kMostDrift_ns * static_cast<double>(host_ns - span_host_ns_) / static_cast<double>(period_ns_);
      fast_spans_ = off_ns > most_ns || off_ns < -most_ns ? std::min(fast_spans_ + 1, 2) : 0;
    }
    span_slaves_ns_ = slaves_ns;
    span_host_ns_ = host_ns;
  }

  std::int64_t period_ns_, wanted_ns_, error_ns_ = 0;
  double drift_ns_ = 0.0;
  std::uint64_t cycles_ = 0;
  int fast_spans_ = 0;
  std::int64_t span_slaves_ns_ = 0, span_host_ns_ = 0;
};

}  // namespace pmg::ethercat
