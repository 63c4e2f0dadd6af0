// How much longer a message travelled than the fastest one of its sender: the order of messages says nothing of their
// age.
#pragma once

#include <cstdint>

namespace pmg::io {

/// Of one sender. The two clocks have different zeros, so a message's delay is counted beyond the fastest one's:
///   delay_k = (received_k - stamp_k) - min over taken j of (received_j - stamp_j), 0 at least.
/// The minimum grows by 1 ms a second, twice the rate at which NTP may slew a clock. Otherwise two clocks that drift
/// apart would make all messages of a long session late. Stamps are the sender's and may be anything.
class Transit {
 public:
  static constexpr std::int64_t kForgetting = 1000;

  /// (stamp by the sender's clock, reception by ours) => delay [ns]; 0 before the first message that was taken. Changes
  /// nothing: a message that is refused must not make later ones late.
  std::int64_t look(std::int64_t stamp_ns, std::int64_t received_ns) const noexcept;
  /// As look(), and takes the message into account.
  std::int64_t take(std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  std::int64_t grown_ns(std::int64_t received_ns) const noexcept;

  std::int64_t smallest_ns_ = 0, taken_ns_ = 0;  // offset; when the last message was taken
  bool any_ = false;
};

}  // namespace pmg::io
