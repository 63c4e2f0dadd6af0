#include "operator/transit.hpp"

#include <algorithm>
#include <utility>

namespace pmg::ops {

std::int64_t Transit::take(std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  const std::int64_t offset_ns = received_ns - stamp_ns;
  smallest_ns_ += (received_ns - received_ns_) / kForgetting;
  received_ns_ = received_ns;
  smallest_ns_ = std::exchange(first_, false) ? offset_ns : std::min(smallest_ns_, offset_ns);
  return offset_ns - smallest_ns_;
}

}  // namespace pmg::ops
