// How many messages one source of operators' messages is listened to: a flood of one takes no room from the others.
#pragma once

#include <array>
#include <cstdint>

#include "control/mode.hpp"

namespace pmg::control {

/// Which messages share one allowance.
enum class MessageKind : std::uint8_t { kCommand, kRequest, kStop };

/// Sources by name, whatever their session: a flood that invents sessions stays one source. For one thread; no heap.
class SourceRates {
 public:
  static constexpr std::size_t kSources = 8;
  /// A source that was silent so long makes room for another one.
  static constexpr std::int64_t kSilent_ns = 500'000'000;

  /// Takes one message into account. False: this source has sent more than it may, or there are too many sources. Stops
  /// of sources without a place share one allowance.
  bool admit(const Source& source, MessageKind kind, std::int64_t now_ns) noexcept;

 private:
  struct Place {
    Source source;  // empty name: free
    std::int64_t heard_ns = 0;
    std::array<std::int64_t, 3> next_ns{};  // by kind: when a steady sender's next message is due
  };

  Place* place_of(const Source& source, std::int64_t now_ns) noexcept;

  std::array<Place, kSources> places_{};
  Place others_;
};

}  // namespace pmg::control
