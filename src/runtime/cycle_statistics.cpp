#include "runtime/cycle_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pmg::runtime {

// Below 16 ns a bucket a nanosecond; above, the leading four bits behind the first one choose among 16 to a doubling.
std::size_t TimeHistogram::bucket_of(std::int64_t time_ns) noexcept {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0));
  constexpr std::uint64_t kSteps = 1u << kStepBits;
  if (value < kSteps) return static_cast<std::size_t>(value);
  const auto exponent = static_cast<std::size_t>(std::bit_width(value)) - 1 - kStepBits;
  const std::uint64_t step = (value >> exponent) - kSteps;
  return std::min((exponent + 1) * kSteps + step, kBuckets - 1);
}

std::int64_t TimeHistogram::upper_ns(std::size_t bucket) noexcept {
  constexpr std::size_t kSteps = 1u << kStepBits;
  if (bucket < kSteps) return static_cast<std::int64_t>(bucket);
  const std::size_t exponent = bucket / kSteps - 1, step = bucket % kSteps;
  return (static_cast<std::int64_t>(kSteps + step + 1) << exponent) - 1;
}

void TimeHistogram::add(std::int64_t time_ns) noexcept {
  ++counts_[bucket_of(time_ns)];
  ++count_;
  max_ns_ = std::max(max_ns_, time_ns);
}

double TimeHistogram::percentile_us(double share) const noexcept {
  const auto rank =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_))));
  std::int64_t seen = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    seen += counts_[bucket];
    if (seen >= rank) return static_cast<double>(std::min(upper_ns(bucket), max_ns_)) * 1e-3;
  }
  return 0.0;
}

void CycleStatistics::add(const control::CycleTiming& cycle) noexcept {
  if (cycles() == 0) first_ns_ = cycle.planned_ns;
  missed_ = cycle.missed;
  wake_.add(cycle.woke_ns - cycle.planned_ns);
  duration_.add(cycle.done_ns - cycle.woke_ns);
  if (cycle.done_ns - cycle.woke_ns > period_ns_) ++overruns_;
  // A cycle that waited for its predecessor's end is late by the controller's own doing: that is an overrun.
  const std::int64_t late_ns = cycle.woke_ns - std::max(cycle.planned_ns, last_done_ns_);
  if (late_ns > kDelayed_ns) {
    ++delayed_count_;
    if (delayed_.size() < kDelayedKept) delayed_.push_back({cycle.planned_ns, late_ns});
  }
  last_done_ns_ = cycle.done_ns;
}

}  // namespace pmg::runtime
