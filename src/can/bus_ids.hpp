// The identifiers of a CAN bus, and who sends them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drives/drive_setup.hpp"

namespace pmg::can {

struct SentId {
  std::uint32_t id = 0;
  std::string who;      ///< "left_knee's replies"
  bool shared = false;  ///< MIT drives may have one identifier for all replies: their first byte tells them apart
};

/// Of this computer's commands, the drives' answers, the IMU's messages and the network's own, in this order.
std::vector<SentId> sent_ids(const drives::BusSetup& bus);

/// Throws std::invalid_argument when two senders of a CAN bus have one identifier.
void check_ids(const drives::DriveSetup& setup);

}  // namespace pmg::can
