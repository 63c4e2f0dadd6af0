// A simulated robot whose drives are reached over CAN: CanHal, emulated drives, MuJoCo with src/sim's actuator models.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "can/can_hal.hpp"
#include "can/emulated_drives.hpp"
#include "hal/hal.hpp"
#include "io/clock.hpp"
#include "sim/world.hpp"

namespace pmg::test {

using Links = std::vector<std::unique_ptr<can::Link>>;

/// Drives answer with their state of the moment in which a command arrives, as real ones do. So a command computed from
/// sample k acts from sample k + 1 on.
class EmulatedRobot final : public hal::Hal {
 public:
  EmulatedRobot(const drives::DriveSetup& setup, const model::RobotModel& robot, sim::World& world, Links host,
                Links drives)
      : world_(world), hal_(setup, robot, still_, std::move(host)), drives_(setup, std::move(drives)) {
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff = JointVector::Zero(robot.joint_index.size());
    for (std::size_t b = 0; b < drives_.buses(); ++b) motors_ += static_cast<long>(drives_.motors(b));
    world_.read(sensed_);
    drives_.feel(sensed_);
  }

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    ++cycles;
    if (before) before(cycles);
    const std::int64_t start_ns = clock_.now_ns();
    if (!frozen) hal_.send(command);
    const std::int64_t sent_ns = clock_.now_ns();
    if (!frozen) asked_ += motors_;
    // A kernel may deliver frames a moment after send().
    for (int wait = 0; wait < 20 && drives_.heard() < asked_ && drives_.wait_ms(1); ++wait) drives_.answer();
    drives_.serve();
    const std::int64_t served_ns = clock_.now_ns();
    const hal::BusStatus status = frozen ? hal::BusStatus::kStale : hal_.receive(state);
    if (costs_ns.size() < costs_ns.capacity()) costs_ns.push_back(clock_.now_ns() - served_ns + sent_ns - start_ns);
    drives_.tick(acting_);
    world_.step(acting_);
    world_.read(sensed_);
    drives_.feel(sensed_);
    if (after) after(cycles, status);
    return world_.diverged() ? hal::BusStatus::kLost : status;
  }

  /// kp = 0 and no feed-forward at every motor: what the drives are really given.
  bool limp_or_damped() const noexcept {
    // Zero lies between two codes of a symmetric field: half a step of torque remains.
    return (acting_.kp.array() == 0.0).all() && (acting_.tau_ff.array().abs() < 0.05).all();
  }

  can::CanHal& hal() { return hal_; }
  EmulatedDrives& drives() { return drives_; }
  const model::JointCommand& acting() const { return acting_; }
  std::function<void(int)> before;                 ///< each exchange, with its number from 1 on: where faults begin
  std::function<void(int, hal::BusStatus)> after;  ///< each exchange
  bool frozen = false;                             ///< the host sends nothing
  int cycles = 0;
  std::vector<std::int64_t> costs_ns;  ///< of the host's part of each cycle, as many as were reserved

 private:
  io::WallClock clock_;
  io::SimulationClock still_;  // a lockstep doesn't pause, however slow its computer is
  sim::World& world_;
  can::CanHal hal_;
  EmulatedDrives drives_;
  model::JointCommand acting_;
  model::RobotState sensed_;
  long motors_ = 0, asked_ = 0;
};

/// Ends of buses without a kernel: the host's, then the drives'.
template <typename Link>
std::pair<Links, Links> link_pairs(std::size_t buses) {
  std::pair<Links, Links> ends;
  for (std::size_t b = 0; b < buses; ++b) {
    auto [host, drives] = Link::pair();
    ends.first.push_back(std::move(host));
    ends.second.push_back(std::move(drives));
  }
  return ends;
}

}  // namespace pmg::test
