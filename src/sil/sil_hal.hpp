// The bus of a simulated robot.
#pragma once

#include "hal/hal.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// (command, world) => (state one physics step later). So a command computed from bus sample k acts during the step
/// that ends in sample k + 1. A diverged simulation counts as a lost bus: the state stays that of the last good sample.
class SilHal final : public hal::Hal {
 public:
  explicit SilHal(sim::World& world) : world_(world) {}
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;

 private:
  sim::World& world_;
};

}  // namespace pmg::sil
