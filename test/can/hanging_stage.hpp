// Z1 in its gantry behind emulated drives, limp and at rest: where first light begins.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "can/emulated_robot.hpp"
#include "can/memory_link.hpp"
#include "model/robots.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::test {

class HangingStage {
 protected:
  /// setup: of the drives that are there; robot.yaml may be another.
  explicit HangingStage(can::DriveSetup setup)
      : setup_(std::move(setup)), world_(z1(), sil::world_with_noise(1, true)) {
    auto [host, far] = link_pairs<MemoryLink>(setup_.buses.size());
    host_ = std::move(host);
    drives_.emplace(setup_, std::move(far));
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff = JointVector::Zero(z1().joint_index.size());
    for (int k = 0; k < 500; ++k) tick();  // limp, it comes to rest
  }
  ~HangingStage() = default;
  void tick() {
    world_.read(sensed_);
    drives_->feel(sensed_);
    drives_->serve();
    drives_->tick(acting_);
    if (hands) hands(acting_);
    world_.step(acting_);
  }

  std::function<void(model::JointCommand&)> hands;  ///< hold the robot's joints somewhere; empty: nobody's
  can::DriveSetup setup_;
  sim::World world_;
  Links host_;
  std::optional<EmulatedDrives> drives_;
  model::JointCommand acting_;
  model::RobotState sensed_;
};

}  // namespace pmg::test
