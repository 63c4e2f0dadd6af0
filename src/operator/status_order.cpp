#include "operator/status_order.hpp"

#include <algorithm>
#include <span>

namespace pmg::ops {

namespace {

/// Foreign stamps may be anything.
std::int64_t difference_ns(std::int64_t a, std::int64_t b) noexcept {
  constexpr std::int64_t kFar_ns = std::int64_t{1} << 61;
  return std::clamp(a, -kFar_ns, kFar_ns) - std::clamp(b, -kFar_ns, kFar_ns);
}

}  // namespace

bool StatusOrder::take(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) noexcept {
  const std::int64_t offset_ns = difference_ns(now_ns, stamp_ns), silent_ns = now_ns - heard_ns_;
  const bool same = any_ && boot == start_.boot;
  if (same) {
    const std::int64_t grown_ns = smallest_offset_ns_ + silent_ns / kDrift;
    if (stamp_ns <= start_.newest_ns || offset_ns > grown_ns + kLate_ns) return false;
    smallest_offset_ns_ = std::min(grown_ns, offset_ns);
  } else {
    if ((any_ && silent_ns <= kSpeaks_ns) || is_earlier(boot, stamp_ns)) return false;
    if (any_) earlier_[earlier_count_++ % kEarlierStarts] = start_;
    smallest_offset_ns_ = offset_ns;
  }
  any_ = true;
  start_ = {.boot = boot, .newest_ns = stamp_ns};
  heard_ns_ = now_ns;
  return true;
}

bool StatusOrder::is_earlier(std::int64_t boot, std::int64_t stamp_ns) const noexcept {
  const auto said = std::span(earlier_).first(std::min(earlier_count_, kEarlierStarts));
  return std::ranges::any_of(said,
                             [&](const Start& start) { return start.boot == boot && stamp_ns <= start.newest_ns; });
}

}  // namespace pmg::ops
