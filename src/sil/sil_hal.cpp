#include "sil/sil_hal.hpp"

namespace pmg::sil {

hal::BusStatus SilHal::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  world_.step(command);
  if (world_.diverged()) return hal::BusStatus::kLost;
  world_.read(state);
  return hal::BusStatus::kOk;
}

}  // namespace pmg::sil
