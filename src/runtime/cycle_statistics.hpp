// Punctuality of a periodic thread: the thread counts it itself, in memory that doesn't grow.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "control/tick_record.hpp"

namespace pmg::runtime {

/// Times in buckets that are 1/16 of their value wide: a percentile is that of its bucket's upper end, at most 7% too
/// high, for any length of run.
class TimeHistogram {
 public:
  void add(std::int64_t time_ns) noexcept;
  std::int64_t count() const noexcept { return count_; }
  double percentile_us(double share) const noexcept;  ///< nearest rank; 0 without samples
  double max_us() const noexcept { return static_cast<double>(max_ns_) * 1e-3; }

 private:
  static constexpr int kStepBits = 4;           // 16 buckets to each doubling
  static constexpr std::size_t kBuckets = 700;  // up to 2^43 ns, more than two hours
  static std::size_t bucket_of(std::int64_t time_ns) noexcept;
  static std::int64_t upper_ns(std::size_t bucket) noexcept;

  std::array<std::int64_t, kBuckets> counts_{};
  std::int64_t count_ = 0, max_ns_ = 0;
};

/// A cycle that began late although the one before had ended in time: the host, not the controller, was late.
struct DelayedCycle {
  std::int64_t planned_ns = 0;
  std::int64_t late_ns = 0;
};

/// One writer, the thread; readers wait until it has ended.
class CycleStatistics {
 public:
  static constexpr std::int64_t kDelayed_ns = 2'000'000;
  static constexpr std::size_t kDelayedKept = 256;  ///< the first ones; all are counted

  explicit CycleStatistics(std::int64_t period_ns) : period_ns_(period_ns) { delayed_.reserve(kDelayedKept); }

  /// One cycle that ended. No heap.
  void add(const control::CycleTiming& cycle) noexcept;

  std::int64_t first_ns() const noexcept { return first_ns_; }  ///< when the first cycle was planned
  std::int64_t cycles() const noexcept { return wake_.count(); }
  std::int64_t missed() const noexcept { return missed_; }      ///< cycles that never ran
  std::int64_t overruns() const noexcept { return overruns_; }  ///< cycles that took longer than a period
  const TimeHistogram& wake() const noexcept { return wake_; }  ///< from the planned to the real start
  const TimeHistogram& duration() const noexcept { return duration_; }
  std::int64_t delayed_count() const noexcept { return delayed_count_; }
  const std::vector<DelayedCycle>& delayed() const noexcept { return delayed_; }

 private:
  std::int64_t period_ns_;
  std::int64_t first_ns_ = 0, missed_ = 0, overruns_ = 0, delayed_count_ = 0, last_done_ns_ = 0;
  TimeHistogram wake_, duration_;
  std::vector<DelayedCycle> delayed_;
};

}  // namespace pmg::runtime
