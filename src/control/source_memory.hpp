// What is remembered of each source of operators' messages: how far it has come, and how long its messages travel.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "control/mode.hpp"

namespace pmg::control {

/// One session of one source.
struct SourceRecord {
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  Source source;                       ///< empty name: free
  std::int64_t last_command = kNever;  ///< sequence of the last one accepted
  std::int64_t last_request = kNever;  ///< likewise
  std::int64_t heard_ns = kNever;      ///< when its last message was received
  /// Smallest (received - stamp) so far. The two clocks have nothing in common, but a message that took longer than
  /// another one shows by how much.
  std::int64_t smallest_offset_ns = 0;
};

/// A fixed number of sources; no heap. Stamps are the senders' and may be anything.
class SourceMemory {
 public:
  static constexpr std::size_t kSources = 8;
  /// A message that travelled so much longer than its session's fastest one is late.
  static constexpr std::int64_t kLate_ns = 200'000'000;
  /// The smallest offset is forgotten by 1 ms a second, twice what NTP may slew a clock by: or two clocks that drift
  /// apart would make all messages of a long session late.
  static constexpr std::int64_t kForgetting = 1000;

  /// The record of a source of this name, whatever its session; null when nothing is remembered.
  SourceRecord* find(const Source& source) noexcept;

  /// The record in which this session's messages are remembered from now on. An earlier session of the name makes room
  /// for it, or else, when all records are taken, the source that was silent longest; kept never does.
  SourceRecord& adopt(const Source& source, const Source& kept, std::int64_t stamp_ns,
                      std::int64_t received_ns) noexcept;

  /// Notes the travelling time of one more message of a remembered session. True: it is late.
  static bool late(SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  std::array<SourceRecord, kSources> records_{};
};

}  // namespace pmg::control
