// A bounded table with a record for each source of operators' messages. No heap.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "control/mode.hpp"

namespace pmg::control {

/// When a source that was never heard was heard last.
inline constexpr std::int64_t kNeverHeard = std::numeric_limits<std::int64_t>::min();

/// Record has `Source source` and `std::int64_t heard_ns = kNeverHeard`. A source that was heard in the last kHeld_ns
/// is never forgotten; rather, a new one finds no room. One operator's sources take no more than kOfOneOperator places
/// in that time, so they can't take the others' room.
template <typename Record>
class SourceTable {
 public:
  static constexpr std::size_t kSources = 64, kOfOneOperator = 8;
  static constexpr std::int64_t kHeld_ns = 1'000'000'000;

  /// Null: not remembered.
  const Record* find(const Source& source) const noexcept {
    const auto found = std::ranges::find_if(records_, of(source));
    return found == records_.end() ? nullptr : &*found;
  }

  /// The source's record, heard now; a new one if there is none. kept: a source whose record is never replaced. Null:
  /// no room.
  Record* hear(const Source& source, std::int64_t received_ns, const Source& kept = {}) noexcept {
    const auto found = std::ranges::find_if(records_, of(source));
    Record* record = found == records_.end() ? make(source, received_ns, kept) : &*found;
    if (record != nullptr) record->heard_ns = std::max(record->heard_ns, received_ns);
    return record;
  }

  const std::array<Record, kSources>& records() const noexcept { return records_; }

 private:
  static auto of(const Source& source) noexcept {
    return [&source](const Record& record) { return heard(record) && record.source == source; };
  }
  static bool heard(const Record& record) noexcept { return record.heard_ns != kNeverHeard; }
  static bool held(const Record& record, std::int64_t received_ns) noexcept {
    return heard(record) && received_ns - record.heard_ns <= kHeld_ns;
  }

  Record* make(const Source& source, std::int64_t received_ns, const Source& kept) noexcept {
    Record* oldest = nullptr;
    std::size_t same_operator = 0;
    for (Record& record : records_) {
      if (held(record, received_ns)) {
        same_operator += record.source.operator_name() == source.operator_name() ? 1 : 0;
      } else if (!heard(record) || record.source != kept) {
        if (oldest == nullptr || record.heard_ns < oldest->heard_ns) oldest = &record;
      }
    }
    if (oldest == nullptr || same_operator >= kOfOneOperator) return nullptr;
    *oldest = Record{};
    oldest->source = source;
    oldest->heard_ns = received_ns;
    return oldest;
  }

  std::array<Record, kSources> records_{};
};

}  // namespace pmg::control
