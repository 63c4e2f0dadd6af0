// A simulated robot behind emulated drives, whatever bus they are on: MuJoCo with src/sim's actuator models.
#pragma once

#include <functional>

#include "can/damping_check.hpp"
#include "can/emulated_drives.hpp"
#include "hal/hal.hpp"
#include "sim/world.hpp"

namespace pmg::test {

/// The emulated drives act on the world, and feel it, in each exchange.
class RobotBehindDrives : public hal::Hal {
 public:
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    ++cycles;
    if (before) before(cycles);
    given_ = command;
    if (meddle) meddle(given_);
    const hal::BusStatus status = cycle(given_, state);
    drives().tick(acting_);
    felt_ = sensed_;
    world_.step(acting_);
    feel();
    if (after) after(cycles, status);
    return world_.diverged() ? hal::BusStatus::kLost : status;
  }

  /// What this joint's drive did in the last cycle was damping, or nothing.
  bool damps(int joint) const noexcept { return damping_.damps(joint, acting_, felt_); }

  virtual EmulatedDrives& drives() noexcept = 0;
  const model::JointCommand& acting() const { return acting_; }
  std::function<void(int)> before;                   ///< each exchange, with its number from 1 on: where faults begin
  std::function<void(int, hal::BusStatus)> after;    ///< each exchange
  std::function<void(model::JointCommand&)> meddle;  ///< changes the command on its way to the bus thread
  bool frozen = false;                               ///< the host sends nothing
  int cycles = 0;

 protected:
  /// Keeps a reference to world. setup: read in the constructor alone.
  RobotBehindDrives(const can::DriveSetup& setup, const model::RobotModel& robot, sim::World& world)
      : world_(world), damping_(setup, robot) {
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff = JointVector::Zero(robot.joint_index.size());
  }
  /// The host's bus cycle, and the drives' answers.
  virtual hal::BusStatus cycle(const model::JointCommand& command, model::RobotState& state) noexcept = 0;
  virtual void feel(const model::RobotState& state) noexcept { drives().feel(state); }
  void feel() noexcept {
    world_.read(sensed_);
    feel(sensed_);
  }

 private:
  sim::World& world_;
  DampingCheck damping_;
  model::JointCommand given_, acting_;
  model::RobotState sensed_, felt_;  // the true robot: now, and when the drives did what they do
};

}  // namespace pmg::test
