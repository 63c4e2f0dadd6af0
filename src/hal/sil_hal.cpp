#include "hal/sil_hal.hpp"

namespace pmg::hal {

BusStatus SilHal::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  world_.step(command);
  if (world_.diverged()) return BusStatus::kLost;
  world_.read(state);
  return BusStatus::kOk;
}

}  // namespace pmg::hal
