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
         std::max<std::int64_t>(offset_ns(record.heard_ns, received_ns), 0) / SourceMemory::kForgetting;
}

}  // namespace

const SourceRecord* SourceMemory::find(const Source& source) const noexcept {
  const auto same_name = [&](const SourceRecord& record) {
    return record.heard_ns != SourceRecord::kNever && record.source.name == source.name;
  };
  const auto found = std::ranges::find_if(records_, same_name);
  return found == records_.end() ? nullptr : &*found;
}

SourceRecord& SourceMemory::adopt(const Source& source, const Source& kept, std::int64_t stamp_ns,
                                  std::int64_t received_ns) noexcept {
  const SourceRecord* known = find(source);
  SourceRecord* record = known == nullptr ? nullptr : &records_[static_cast<std::size_t>(known - records_.data())];
  if (record != nullptr && record->source == source) {
    record->smallest_offset_ns = std::min(grown_offset_ns(*record, received_ns), offset_ns(stamp_ns, received_ns));
    record->heard_ns = std::max(record->heard_ns, received_ns);
    return *record;
  }
  if (record == nullptr) {
    for (SourceRecord& candidate : records_) {
      const bool free = candidate.heard_ns == SourceRecord::kNever;
      if (!free && candidate.source == kept) continue;
      if (record == nullptr || candidate.heard_ns < record->heard_ns) record = &candidate;
    }
  }
  *record = {.source = source, .heard_ns = received_ns, .smallest_offset_ns = offset_ns(stamp_ns, received_ns)};
  return *record;
}

bool SourceMemory::late(const SourceRecord& record, std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  return offset_ns(stamp_ns, received_ns) - grown_offset_ns(record, received_ns) > kLate_ns;
}

}  // namespace pmg::control
