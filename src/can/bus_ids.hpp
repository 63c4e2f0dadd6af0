// The identifiers of a CAN bus, and who sends them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "drives/message.hpp"

namespace pmg::can {

struct SentId {
  std::uint32_t id = 0;
  std::string who;                  ///< "left_knee's replies"
  const char* shared_by = nullptr;  ///< drives of this protocol may have one identifier for all replies: `mark` tells
                                    ///< them apart; null: nobody else may have it
  int mark = 0;
};

/// Of this computer's commands, the drives' answers, the IMU's messages and the network's own, in this order.
std::vector<SentId> sent_ids(const BusSetup& bus);

/// Throws std::invalid_argument when two senders of a CAN bus have one identifier and nothing tells them apart.
void check_ids(const DriveSetup& setup);

/// The identifiers with which the drives of a bus, and its IMU, send to this computer: a receive filter.
std::vector<std::uint32_t> awaited_ids(const BusSetup& bus);

/// The node of a drive that the bus isn't to have, if it sent this frame, which is none of the bus's motors': an answer
/// as its drives give them, or one of a CANopen drive's messages of the cycle. No heap.
std::optional<int> stranger(const BusSetup& bus, const drives::Message& frame) noexcept;

}  // namespace pmg::can
