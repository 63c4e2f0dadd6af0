// Whole controllers on a network without sockets and with a virtual clock: bus, control and comms of one or more robots
// and their operators in one thread.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "control/control_cycle.hpp"
#include "control/fixtures.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "runtime/comms.hpp"

namespace pmg::test {

struct NetworkedRobot {
  NetworkedRobot(const std::string& name, io::LcmLink& link, const io::Clock& clock,
                 const std::optional<seal::ControllerKeys>& keys = std::nullopt,
                 const model::RobotModel& model = biped())
      : robot(model),
        run{.robot = name, .session = 1},
        comms(link, inbox, outbox, robot, run, 100.0, clock, seal::ControllerSeal(keys)),
        clock_(clock) {
    bus_cycle.run();  // the first sample
  }

  /// One control tick. As in the controller's threads, messages sent before are received first.
  void control() {
    cycle.run(clock_.now_ns());
    outbox.publish(cycle.record());
    if (acks_lost) outbox.acks.reset();
  }
  const control::TickResult& result() const { return cycle.record().result; }

  bool acks_lost = false;
  const model::RobotModel& robot;
  recording::RunInfo run;
  hal::BusLink bus_link;
  control::OperatorInbox inbox{bus_link.stop};
  control::ControllerOutbox outbox;
  runtime::Comms comms;

 private:
  const io::Clock& clock_;

 public:
  IdealBus bus{robot};
  hal::BusCycle bus_cycle{bus, bus_link, robot, clock_};
  BreakablePolicy* policy = new BreakablePolicy;
  control::Tick tick{robot, clips(robot), std::unique_ptr<policy::Policy>(policy), clock_,
                     control::tick_options(robot)};
  control::ControlCycle cycle{tick, bus_link, inbox, clock_};
};

class Network {
 public:
  NetworkedRobot& add_robot(const std::string& name, const std::optional<seal::ControllerKeys>& keys = std::nullopt,
                            const model::RobotModel& model = biped()) {
    return robots_.emplace_back(name, link, clock, keys, model);
  }

  /// 10 ms of every robot; messages are delivered meanwhile.
  void advance() {
    for (int bus_cycle = 0; bus_cycle < 5; ++bus_cycle) {
      clock.advance_to(clock.now_ns() + hal::BusCycle::kPeriod_ns);
      link.receive(0);
      for (NetworkedRobot& robot : robots_) {
        robot.bus_cycle.run();
        if (bus_cycle == 0 && control_alive) robot.control();
        if (comms_alive) robot.comms.step(0);
      }
    }
  }
  /// Steps until the operator's request has ended, at most for at_most_s.
  template <typename Errand>
  auto finish(Errand& errand, double at_most_s = 30.0) {
    auto progress = errand.step();
    for (const auto pending = progress; progress == pending && at_most_s > 0.0; at_most_s -= 0.01) {
      advance();
      progress = errand.step();
    }
    return progress;
  }

  io::SimulationClock clock;
  io::LcmLink link{"memq://"};
  bool control_alive = true;
  bool comms_alive = true;  ///< false: the controllers hear, but nothing is heard of them

 private:
  std::deque<NetworkedRobot> robots_;
};

}  // namespace pmg::test
