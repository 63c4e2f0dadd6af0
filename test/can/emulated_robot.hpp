// A simulated robot whose drives are reached over CAN: CanHal, emulated drives, MuJoCo with src/sim's actuator models.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/robot_behind_drives.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "io/clock.hpp"

namespace pmg::test {

using Links = std::vector<std::unique_ptr<can::Link>>;

/// Drives answer with their state of the moment in which a command arrives, as real ones do. So a command computed from
/// sample k acts from sample k + 1 on.
class EmulatedRobot final : public RobotBehindDrives {
 public:
  EmulatedRobot(const can::DriveSetup& setup, const model::RobotModel& robot, sim::World& world, Links host,
                Links drives)
      : RobotBehindDrives(setup, robot, world),
        drives_(setup, std::move(drives)),
        hal_(setup, robot, still_, set_up(setup, std::move(host))) {
    for (std::size_t b = 0; b < drives_.buses(); ++b) {
      motors_ += static_cast<long>(drives_.motors(b));
      for (const drives::MotorSetup& motor : setup.buses[b].motors)
        canopen_ += drives::as_cia402(motor.drive) != nullptr ? 1 : 0;
    }
    feel();
  }

  can::CanHal& hal() { return hal_; }
  EmulatedDrives& drives() noexcept override { return drives_; }
  std::vector<std::int64_t> costs_ns;  ///< of the host's part of each cycle, as many as were reserved

 private:
  hal::BusStatus cycle(const model::JointCommand& command, model::RobotState& state) noexcept override {
    const std::int64_t start_ns = clock_.now_ns();
    if (!frozen) hal_.send(command);
    const std::int64_t sent_ns = clock_.now_ns();
    if (!frozen) asked_ += motors_;
    // A kernel may deliver frames a moment after send().
    for (int wait = 0; wait < 20 && drives_.heard() < asked_ && drives_.wait_ms(1); ++wait) drives_.answer();
    drives_.serve();
    const std::int64_t served_ns = clock_.now_ns();
    const hal::BusStatus status = frozen ? hal::BusStatus::kStale : hal_.receive(state);
    const std::int64_t done_ns = clock_.now_ns();
    if (!frozen) awaited_ += canopen_;
    for (int wait = 0; wait < 20 && drives_.obeyed() < awaited_ && drives_.wait_ms(1); ++wait) drives_.answer();
    drives_.answer();
    if (costs_ns.size() < costs_ns.capacity()) costs_ns.push_back(done_ns - served_ns + sent_ns - start_ns);
    return status;
  }
  /// CANopen drives are set up before the first cycle.
  Links set_up(const can::DriveSetup& setup, Links host) {
    can::set_up_nodes(setup, host,
                      [this] {
                        drives_.wait_ms(1);
                        drives_.answer();
                      },
                      {});
    return host;
  }

  io::WallClock clock_;
  io::SimulationClock still_;  // a lockstep doesn't pause, however slow its computer is
  EmulatedDrives drives_;
  can::CanHal hal_;
  long motors_ = 0, asked_ = 0, canopen_ = 0, awaited_ = 0;
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
