// What the bus thread needs of a robot's drives. Backends (hal/backend.hpp) give it.
#pragma once

#include "model/robot_io.hpp"

namespace pmg::hal {

enum class BusStatus { kOk, kStale, kLost };

/// One bus cycle at 500 Hz. Implementations don't allocate, lock or throw in exchange().
class Hal {
 public:
  virtual ~Hal() = default;
  /// Sends the command, advances or waits for one bus cycle, and fills the state; age_ns where a motor's part of it is
  /// older than this cycle.
  virtual BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept = 0;
};

}  // namespace pmg::hal
