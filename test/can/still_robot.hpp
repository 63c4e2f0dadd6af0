// A robot's drives and its bus cycle over memory, without physics: joints stand where a test puts them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../sim/robots.hpp"
#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"

namespace pmg::test {

/// Z1 with these drives; fixtures derive from it.
class StillRobot {
 protected:
  explicit StillRobot(can::DriveSetup setup) : setup_(std::move(setup)) {
    std::vector<std::unique_ptr<can::Link>> far;
    for (std::size_t b = 0; b < setup_.buses.size(); ++b) {
      auto [here, there] = MemoryLink::pair();
      host_.push_back(here.get());
      links_.push_back(std::move(here));
      far.push_back(std::move(there));
    }
    drives_.emplace(setup_, std::move(far));
    truth_.q = z1().q_stand();
    truth_.dq = truth_.tau = JointVector::Zero(truth_.q.size());
    drives_->feel(truth_);
    acting_ = limp();
  }
  /// The bus thread takes the links, after CANopen drives were set up over them.
  void connect() {
    can::set_up_nodes(setup_, links_, wait_, {});
    hal_.emplace(setup_, z1(), clock_, std::move(links_));
  }
  hal::BusStatus cycle(const model::JointCommand& command) {
    drives_->feel(truth_);
    hal_->send(command);
    drives_->serve();
    const hal::BusStatus status = hal_->receive(state_);
    drives_->answer();  // targets of CANopen drives
    drives_->tick(acting_);
    return status;
  }
  /// Cycles from the first one that carries the cause to the first that reports this; -1: none of `most` does.
  int cycles_until(hal::BusStatus wanted, int most = 400) {
    for (int k = 0; k < most; ++k) {
      if (cycle(standing_) == wanted) return k;
    }
    return -1;
  }
  static model::JointCommand limp() {
    model::JointCommand command = damping();
    command.kd.setZero();
    return command;
  }
  static model::JointCommand damping() {
    model::JointCommand command = standing_command(z1());
    command.kp.setZero();
    return command;
  }
  std::string trouble() const { return describe(hal_->trouble(), setup_); }

  can::DriveSetup setup_;
  io::SimulationClock clock_;
  std::vector<MemoryLink*> host_;                  // this computer's end of each bus
  std::vector<std::unique_ptr<can::Link>> links_;  // the same, until connect()
  std::optional<EmulatedDrives> drives_;
  std::optional<can::CanHal> hal_;
  can::Wait wait_ = [this] { drives_->answer(); };
  model::RobotState truth_, state_;
  model::JointCommand acting_, standing_ = standing_command(z1());
};

}  // namespace pmg::test
