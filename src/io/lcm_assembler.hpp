// (datagrams) => (messages of wanted channels): LCM's public wire format, read with bounds.
//
// A short message:  "LC02", number, channel and its zero byte, payload.
// A fragment:       "LC03", number, size of the whole payload, offset of this part, index and count of fragments, then
// in
//                   the first one channel and zero byte, then this part of the payload. All numbers are big-endian.
//
// liblcm's own receiver, up to its newest release 1.5.2, adds offset and size of a fragment in 32 bits and searches the
// end of a channel's name behind the end of the datagram. Two datagrams then end the program.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::io {

using Bytes = std::span<const std::uint8_t>;

/// Valid until the assembler takes the next datagram.
struct LcmMessage {
  std::size_t channel = 0;  ///< as want() numbered it
  Bytes payload;
};

/// All memory is allocated in the constructor and in want(): a datagram allocates nothing. A sender's fragments must
/// come in order, as every LCM library sends them; a message that lost one is dropped.
class LcmAssembler {
 public:
  static constexpr std::size_t kLongestChannel = 63;          ///< LCM's own limit
  static constexpr std::size_t kLargestMessage = 256 * 1024;  ///< ROBOT_INFO, the largest of ours, has some 20 KiB
  static constexpr std::size_t kPlaces = 4;                   ///< messages that may be incomplete at a time

  /// Datagrams, by their end.
  struct Counts {
    std::int64_t messages = 0;   ///< completed a message of a wanted channel
    std::int64_t fragments = 0;  ///< taken, message not complete yet
    std::int64_t unwanted = 0;   ///< of another channel, duplicated, or of a message whose beginning was not taken
    std::int64_t malformed = 0;  ///< not LCM, cut short, or numbers that contradict each other
    std::int64_t incomplete =
        0;  ///< messages that were begun and dropped, because a fragment is missing or is malformed
  };

  LcmAssembler();

  /// Messages of this channel are passed on. Returns the channel's number: 0, 1, ...
  std::size_t want(std::string channel);

  /// sender: different for different senders' sockets.
  std::optional<LcmMessage> take(std::uint64_t sender, Bytes datagram) noexcept;

  const Counts& counts() const noexcept { return counts_; }

 private:
  /// A message of which the first `next` fragments have arrived: `filled` bytes.
  struct Place {
    bool used = false;
    std::uint64_t sender = 0;
    std::uint32_t number = 0;
    std::size_t size = 0, filled = 0, channel = 0;
    std::uint16_t next = 0, count = 0;
    std::int64_t begun = 0;  // order of beginnings: the oldest makes room
    std::vector<std::uint8_t> bytes;
  };

  std::optional<LcmMessage> take_short(Bytes rest) noexcept;
  std::optional<LcmMessage> take_fragment(std::uint64_t sender, Bytes datagram) noexcept;
  std::optional<std::size_t> find_channel(std::string_view name) const noexcept;
  /// A fragment that the network has duplicated.
  static bool repeats(const Place& place, std::size_t offset, std::uint16_t index, Bytes part) noexcept;
  Place* place_of(std::uint64_t sender) noexcept;
  Place& begin(std::uint64_t sender) noexcept;
  void drop(Place& place) noexcept;

  std::vector<std::string> channels_;
  std::array<Place, kPlaces> places_{};
  std::int64_t begun_ = 0;
  Counts counts_;
};

}  // namespace pmg::io
