#include "seal/status_order.hpp"

#include <algorithm>
#include <span>

namespace pmg::seal {

bool StatusOrder::news(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) const noexcept {
  if (!any_) return true;
  if (boot != start_.boot) return now_ns - heard_ns_ > kSpeaks_ns && !is_earlier(boot, stamp_ns);
  return stamp_ns > start_.newest_ns && transit_.look(stamp_ns, now_ns) <= kLate_ns;
}

bool StatusOrder::take(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) noexcept {
  if (!news(boot, stamp_ns, now_ns)) return false;
  const bool same = any_ && boot == start_.boot;
  if (any_ && !same) earlier_[earlier_count_++ % kEarlierStarts] = start_;
  if (!same) transit_ = {};
  transit_.take(stamp_ns, now_ns);
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

}  // namespace pmg::seal
