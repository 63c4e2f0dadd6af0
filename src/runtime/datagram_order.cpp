#include "runtime/datagram_order.hpp"

#include "seal/controller_seal.hpp"

namespace pmg::runtime {

DatagramOrder::Place DatagramOrder::take(const control::Source& source, Stream stream, std::int64_t sequence,
                                         std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  // Whoever is forgotten while his messages are fresh could be played back.
  static_assert(decltype(table_)::kHeld_ns >= seal::ControllerSeal::kFresh_ns);
  Record* record = table_.hear(source, received_ns);
  if (record == nullptr) return Place::kNoRoom;
  Newest& newest = record->newest[static_cast<std::size_t>(stream)];
  const bool higher = sequence > newest.sequence;
  if (!higher && (sequence < newest.sequence || stamp_ns <= newest.stamp_ns)) return Place::kOld;
  newest = {.sequence = sequence, .stamp_ns = stamp_ns};
  return higher ? Place::kNew : Place::kRepeated;
}

}  // namespace pmg::runtime
