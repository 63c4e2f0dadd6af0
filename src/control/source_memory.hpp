// Remembers each source of operators' messages: its last numbers, how its last request was judged, its fastest message.
#pragma once

#include <cstdint>

#include "control/mode.hpp"
#include "control/source_table.hpp"
#include "io/transit.hpp"

namespace pmg::control {

/// One session of one source.
struct SourceRecord {
  static constexpr std::int64_t kNever = kNeverHeard;

  Source source;
  std::int64_t heard_ns = kNever;      ///< when its last message was received, taken or refused
  std::int64_t taken_ns = kNever;      ///< likewise, of those that were taken
  std::int64_t last_command = kNever;  ///< sequence of the last one that was judged
  std::int64_t last_arms = kNever;     ///< likewise
  std::int64_t last_request = kNever;  ///< likewise; what it asked for and how it was judged:
  Mode asked_mode = Mode::kPassive;
  bool asked_reset = false;
  Verdict verdict = Verdict::kTaken;
  io::Transit transit{};  ///< of the messages that were taken
};

/// A fixed number of sources (SourceTable); no heap. Stamps are the senders' and may be anything.
class SourceMemory {
 public:
  /// After so long without a message that was taken, a session no longer refuses smaller ones. Otherwise one message
  /// with the largest number of all would lock a name out for ever.
  static constexpr std::int64_t kSessionHolds_ns = 10'000'000'000;
  /// A message is late when it travelled this much longer than the fastest one of its session.
  static constexpr std::int64_t kLate_ns = 200'000'000;

  /// The record of this session; null when nothing is remembered.
  const SourceRecord* find(const Source& source) const noexcept { return table_.find(source); }
  /// A message of a later session of this name was taken.
  bool ended(const Source& source, std::int64_t received_ns) const noexcept;

  /// The session's record from now on, whatever becomes of its message. kept is never replaced. Null: there is no room.
  SourceRecord* hear(const Source& source, const Source& kept, std::int64_t received_ns) noexcept {
    return table_.hear(source, received_ns, kept);
  }
  /// A message of this session was taken.
  static void take(SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

  /// Whether a message of this record's session travelled too long. Changes nothing: a message that is refused must not
  /// make later ones late.
  static bool late(const SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  SourceTable<SourceRecord> table_;
};

}  // namespace pmg::control
