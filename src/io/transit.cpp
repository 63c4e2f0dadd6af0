#include "io/transit.hpp"

#include <algorithm>

namespace pmg::io {

namespace {

/// (a, b) => a - b.
std::int64_t difference_ns(std::int64_t a, std::int64_t b) noexcept {
  constexpr std::int64_t kFar_ns = std::int64_t{1} << 61;  // 73 years: differences of such times don't overflow
  return std::clamp(a, -kFar_ns, kFar_ns) - std::clamp(b, -kFar_ns, kFar_ns);
}

}  // namespace

std::int64_t Transit::grown_ns(std::int64_t received_ns) const noexcept {
  return smallest_ns_ + std::max<std::int64_t>(difference_ns(received_ns, taken_ns_), 0) / kForgetting;
}

std::int64_t Transit::look(std::int64_t stamp_ns, std::int64_t received_ns) const noexcept {
  if (!any_) return 0;
  return std::max<std::int64_t>(difference_ns(received_ns, stamp_ns) - grown_ns(received_ns), 0);
}

std::int64_t Transit::take(std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  const std::int64_t delay_ns = look(stamp_ns, received_ns), offset_ns = difference_ns(received_ns, stamp_ns);
  smallest_ns_ = any_ ? std::min(grown_ns(received_ns), offset_ns) : offset_ns;
  taken_ns_ = any_ ? std::max(taken_ns_, received_ns) : received_ns;
  any_ = true;
  return delay_ns;
}

}  // namespace pmg::io
