#include "control/source_memory.hpp"

#include <algorithm>

namespace pmg::control {

bool SourceMemory::ended(const Source& source, std::int64_t received_ns) const noexcept {
  return std::ranges::any_of(table_.records(), [&](const SourceRecord& record) {
    return record.taken_ns != SourceRecord::kNever && record.source.name == source.name &&
           record.source.session > source.session && received_ns - record.taken_ns <= kSessionHolds_ns;
  });
}

void SourceMemory::take(SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  record.transit.take(stamp_ns, received_ns);
  record.taken_ns = std::max(record.taken_ns, received_ns);
}

bool SourceMemory::late(const SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  return record.transit.look(stamp_ns, received_ns) > kLate_ns;
}

}  // namespace pmg::control
