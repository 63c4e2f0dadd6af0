// Limits the rate of each operator's messages, so that a flood from one takes no room from the others.
#pragma once

#include <array>
#include <cstdint>

#include "control/mode.hpp"

namespace pmg::runtime {

/// Which messages share one allowance.
enum class MessageKind : std::uint8_t { kCommand, kRequest, kStop, kArms };

/// Counts by operator (Source::operator_name), not by source: a flood that invents sessions or names of its own stays
/// one. For one thread; no heap.
class SourceRates {
 public:
  static constexpr std::size_t kOperators = 8;
  /// An operator who was silent for so long loses its place to another one.
  static constexpr std::int64_t kSilent_ns = 500'000'000;

  /// Takes one message into account. False: this operator has sent too many, or there are too many of them. Those
  /// without a place share one allowance for stops.
  bool admit(const control::Source& source, MessageKind kind, std::int64_t now_ns) noexcept;
  /// A stop that anybody may have sent: shares the unknown-sender allowance, occupies no slot.
  bool admit_stranger(std::int64_t now_ns) noexcept { return admit(others_, MessageKind::kStop, now_ns); }

 private:
  struct Place {
    control::Source source;  // one of the operator's; empty name: free
    std::int64_t heard_ns = 0;
    std::array<std::int64_t, 4> next_ns{};  // by kind: when a steady sender's next message is due
  };

  static bool admit(Place& place, MessageKind kind, std::int64_t now_ns) noexcept;
  Place* place_of(const control::Source& source, std::int64_t now_ns) noexcept;

  std::array<Place, kOperators> places_{};
  Place others_;
};

}  // namespace pmg::runtime
