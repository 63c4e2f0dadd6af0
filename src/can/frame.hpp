// One CAN frame, classic or FD, and what goes wrong on a bus.
#pragma once

#include <cstdint>

#include "drives/message.hpp"

namespace pmg::can {

using Frame = drives::Message;

/// What the CAN controller of this computer says of its bus.
enum class BusHealth : std::uint8_t {
  kGood,
  kPassive,  ///< error-passive: every frame meets errors, or nobody acknowledges it
  kOff,      ///< bus-off, or the interface is down: nothing is sent
};

}  // namespace pmg::can
