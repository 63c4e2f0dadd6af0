// How late a far device's messages are: their order says nothing of their age.
#pragma once

#include <cstdint>

namespace pmg::ops {

/// Of one connection. The two clocks have different zeros, so a message's delay is counted beyond the fastest one's:
///   delay_k = (received_k - stamp_k) - min over j <= k of (received_j - stamp_j).
/// The minimum grows by 1 ms a second, as in a controller (src/control/source_memory.hpp): clocks drift apart.
class Transit {
 public:
  static constexpr std::int64_t kForgetting = 1000;
  static constexpr std::int64_t kLate_ns = 200'000'000;  ///< a message that is later says nothing of this moment

  /// (stamp by the device's clock, reception by ours) => delay [ns].
  std::int64_t take(std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  std::int64_t smallest_ns_ = 0, received_ns_ = 0;
  bool first_ = true;
};

}  // namespace pmg::ops
