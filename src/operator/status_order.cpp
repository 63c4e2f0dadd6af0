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

std::int64_t StatusOrder::grown_offset_ns(std::int64_t now_ns) const noexcept {
  return smallest_offset_ns_ + (now_ns - heard_ns_) / kDrift;
}

bool StatusOrder::news(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) const noexcept {
  if (!any_) return true;
  if (boot != start_.boot) return now_ns - heard_ns_ > kSpeaks_ns && !is_earlier(boot, stamp_ns);
  return stamp_ns > start_.newest_ns && difference_ns(now_ns, stamp_ns) <= grown_offset_ns(now_ns) + kLate_ns;
}

bool StatusOrder::take(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) noexcept {
  if (!news(boot, stamp_ns, now_ns)) return false;
  const std::int64_t offset_ns = difference_ns(now_ns, stamp_ns);
  const bool same = any_ && boot == start_.boot;
  if (any_ && !same) earlier_[earlier_count_++ % kEarlierStarts] = start_;
  smallest_offset_ns_ = same ? std::min(grown_offset_ns(now_ns), offset_ns) : offset_ns;
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
