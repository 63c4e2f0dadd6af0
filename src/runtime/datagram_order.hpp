// Lets each datagram of operators through once: what was recorded on the network costs its sender nothing.
#pragma once

#include <array>
#include <cstdint>

#include "control/mode.hpp"
#include "control/source_table.hpp"

namespace pmg::runtime {

/// Messages that share one row of numbers.
enum class Stream : std::uint8_t { kCommand, kRequest, kArms, kHoist };

/// For messages with a good seal, in one thread. A source's numbers increase; a repetition keeps the number and has a
/// later stamp. All other messages are ones that were looked at before, or that newer ones overtook.
class DatagramOrder {
 public:
  enum class Place {
    kNew,       ///< a higher number than any before
    kRepeated,  ///< the newest number again, made later
    kOld,       ///< looked at before, or overtaken
    kNoRoom,    ///< so many sources in the last second that this one can't be remembered
  };

  /// Remembers the message, whatever becomes of it.
  Place take(const control::Source& source, Stream stream, std::int64_t sequence, std::int64_t stamp_ns,
             std::int64_t received_ns) noexcept;

 private:
  struct Newest {
    std::int64_t sequence = control::kNeverHeard, stamp_ns = control::kNeverHeard;
  };
  struct Record {
    control::Source source;
    std::int64_t heard_ns = control::kNeverHeard;
    std::array<Newest, 4> newest{};  // by Stream
  };

  control::SourceTable<Record> table_;
};

}  // namespace pmg::runtime
