#include "control/source_memory.hpp"

#include <algorithm>

namespace pmg::control {

namespace {

std::int64_t offset_ns(std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  constexpr std::int64_t kFar_ns = std::int64_t{1} << 61;  // 73 years: differences of such times don't overflow
  return std::clamp(received_ns, -kFar_ns, kFar_ns) - std::clamp(stamp_ns, -kFar_ns, kFar_ns);
}

/// The smallest offset, grown until now.
std::int64_t grown_offset_ns(const SourceRecord& record, std::int64_t received_ns) noexcept {
  return record.smallest_offset_ns +
         std::max<std::int64_t>(offset_ns(record.taken_ns, received_ns), 0) / SourceMemory::kForgetting;
}

}  // namespace

bool SourceMemory::ended(const Source& source, std::int64_t received_ns) const noexcept {
  return std::ranges::any_of(table_.records(), [&](const SourceRecord& record) {
    return record.taken_ns != SourceRecord::kNever && record.source.name == source.name &&
           record.source.session > source.session && received_ns - record.taken_ns <= kSessionHolds_ns;
  });
}

void SourceMemory::take(SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  const bool first = record.taken_ns == SourceRecord::kNever;
  const std::int64_t offset = offset_ns(stamp_ns, received_ns);
  record.smallest_offset_ns = first ? offset : std::min(grown_offset_ns(record, received_ns), offset);
  record.taken_ns = std::max(record.taken_ns, received_ns);
}

bool SourceMemory::late(const SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  if (record.taken_ns == SourceRecord::kNever) return false;  // nothing to compare it with
  return offset_ns(stamp_ns, received_ns) - grown_offset_ns(record, received_ns) > kLate_ns;
}

}  // namespace pmg::control
