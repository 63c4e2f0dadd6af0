// A request that waits for its answer.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "pmg_msgs/ack_t.hpp"
#include "seal/authentication.hpp"

namespace pmg::seal {

/// Knows the messages by which its source asked: an answer names one of them, or is another request's.
class AskedRequest {
 public:
  static constexpr std::size_t kRemembered = 32;  ///< repetitions, 50 ms apart

  void begin() noexcept { count_ = 0; }  ///< another request
  void sent(const Digest& digest) noexcept { sent_[count_++ % kRemembered] = digest; }

  bool answered_by(const pmg_msgs::ack_t& ack) const noexcept {
    return std::ranges::any_of(std::span(sent_).first(std::min(count_, kRemembered)),
                               [&](const Digest& digest) { return std::ranges::equal(digest, ack.digest); });
  }

 private:
  std::array<Digest, kRemembered> sent_{};  // a ring
  std::size_t count_ = 0;
};

}  // namespace pmg::seal
