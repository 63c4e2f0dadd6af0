// Remembers each source of operators' messages: its last sequence numbers and its fastest message.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "control/mode.hpp"
#include "control/source_rates.hpp"

namespace pmg::control {

/// One session of one source.
struct SourceRecord {
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  Source source;                       ///< empty name: free
  std::int64_t last_command = kNever;  ///< sequence of the last one accepted
  std::int64_t last_request = kNever;  ///< likewise
  std::int64_t last_arms = kNever;     ///< likewise
  std::int64_t heard_ns = kNever;      ///< when its last message was received
  /// Smallest (received - stamp) so far. The two clocks have different zeros; the difference between two messages still
  /// shows how much longer one of them travelled.
  std::int64_t smallest_offset_ns = 0;
};

/// A fixed number of sources; no heap. Stamps are the senders' and may be anything.
class SourceMemory {
 public:
  /// A source of the last second is never forgotten: SourceRates admits at most two names a place in that time, and one
  /// more may drive.
  static constexpr std::size_t kSources = 2 * SourceRates::kSources + 1;
  /// After so long without a message of it a session no longer refuses smaller ones. Otherwise one message with the
  /// largest number of all would lock a name out for ever.
  static constexpr std::int64_t kSessionHolds_ns = 10'000'000'000;
  /// A message is late when it travelled this much longer than the fastest one of its session.
  static constexpr std::int64_t kLate_ns = 200'000'000;
  /// The smallest offset grows by 1 ms a second, twice the rate at which NTP may slew a clock. Otherwise two clocks
  /// that drift apart would make all messages of a long session late.
  static constexpr std::int64_t kForgetting = 1000;

  /// The record of a source of this name, whatever its session; null when nothing is remembered.
  const SourceRecord* find(const Source& source) const noexcept;

  /// The record for this session's messages from now on, after one that was accepted. It replaces another session of
  /// the name or, when all records are taken, the source that was silent longest. kept is never replaced.
  SourceRecord& adopt(const Source& source, const Source& kept, std::int64_t stamp_ns,
                      std::int64_t received_ns) noexcept;

  /// Whether a message of this record's session travelled too long. Changes nothing: a message that is refused must not
  /// make later ones late.
  static bool late(const SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  std::array<SourceRecord, kSources> records_{};
};

}  // namespace pmg::control
