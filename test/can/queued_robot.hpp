// Motors of one bus of Z1 behind queues, their bus cycle, and somebody who damps them after a loss and lets them stand
// again.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../sim/robots.hpp"
#include "can/can_hal.hpp"
#include "can/queued_bus.hpp"

namespace pmg::test {

class QueuedRobot {
 public:
  static constexpr std::int64_t kPeriod_ns = 2'000'000, kWait_ns = 500'000;
  static constexpr int kDampedCycles = 25;  ///< good ones, before it stands again

  QueuedRobot(std::size_t motors, std::size_t room) {
    setup_ = can::load_drives(z1());
    std::erase_if(setup_.buses,
                  [](const can::BusSetup& other) { return other.name != "can2"; });  // an arm: seven motors
    setup_.buses[0].motors.erase(setup_.buses[0].motors.begin() + static_cast<std::ptrdiff_t>(motors),
                                 setup_.buses[0].motors.end());
    auto link = std::make_unique<QueuedBus>(setup_.buses[0], room);
    bus = link.get();
    std::vector<std::unique_ptr<can::Link>> links;
    links.push_back(std::move(link));
    hal.emplace(setup_, z1(), clock_, std::move(links));
    damping_ = standing_ = standing_command(z1());
    damping_.kp.setZero();
  }

  /// One bus cycle. stall_ns: the computer stops for so long after it.
  hal::BusStatus cycle(std::int64_t stall_ns = 0) {
    for (std::size_t m = 0; m < bus->motors(); ++m) {
      const double t_s = 1e-9 * static_cast<double>(now_ns_), speed_rad_s = 6.0;
      bus->drive(m).feel({.q_rad = 0.1 * std::sin(speed_rad_s * t_s), .dq_rad_s = 0.6 * std::cos(speed_rad_s * t_s)});
    }
    clock_.advance_to(now_ns_);
    hal->send(stands ? standing_ : damping_);
    bus->run_to(now_ns_ + kWait_ns);
    const hal::BusStatus status = hal->receive(state);
    good_cycles_ = status == hal::BusStatus::kOk ? good_cycles_ + 1 : 0;
    if (status == hal::BusStatus::kLost) stands = false;
    if (good_cycles_ >= kDampedCycles) stands = true;
    now_ns_ += kPeriod_ns + stall_ns;
    bus->run_to(now_ns_);
    for (std::int64_t t = 0; t <= stall_ns; t += kPeriod_ns) {
      for (std::size_t m = 0; m < bus->motors(); ++m) bus->drive(m).tick();
    }
    return status;
  }
  std::int64_t now_ns() const { return now_ns_; }
  std::string trouble() const { return describe(hal->trouble(), setup_); }
  drives::Trouble trouble(std::size_t motor) const { return hal->motor(0, motor).trouble(false); }

  QueuedBus* bus = nullptr;
  std::optional<can::CanHal> hal;
  model::RobotState state;
  bool stands = false;

 private:
  can::DriveSetup setup_;
  io::SimulationClock clock_;
  model::JointCommand standing_, damping_;
  std::int64_t now_ns_ = kPeriod_ns;
  int good_cycles_ = 0;
};

}  // namespace pmg::test
