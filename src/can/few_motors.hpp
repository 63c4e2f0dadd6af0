// One motor of a bus, or those of one linkage, driven alone, the others switched off. They go at the pace of their
// answers: an ordinary computer or a slow adapter may bring one 10 ms late.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/canopen_setup.hpp"
#include "can/link.hpp"
#include "drives/motor_channel.hpp"

namespace pmg::can {

class FewMotors {
 public:
  /// Sets CANopen drives up and waits for the first answers, drives off. tick is called every 2 ms and waits; emulators
  /// answer in it. others: gets what isn't these motors'; empty: nobody wants to know. Throws std::runtime_error: a
  /// motor doesn't answer, or its drive isn't as robot.yaml has it. Keeps references; motors: of the bus.
  FewMotors(const BusSetup& bus, std::span<const drives::MotorSetup* const> motors, Link& link,
            const std::function<void()>& tick, std::function<void(const drives::Message&)> others = {});
  FewMotors(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const std::function<void()>& tick,
            std::function<void(const drives::Message&)> others = {});
  ~FewMotors();  ///< switches them off
  FewMotors(const FewMotors&) = delete;
  FewMotors& operator=(const FewMotors&) = delete;

  /// Switches the drives on without stiffness. False: one doesn't follow within 0.5 s.
  bool switch_on();
  /// One bus cycle. wanted: of each motor, before its transmission: at its joint, or at its crank. Throws
  /// std::runtime_error when a motor is in trouble.
  void exchange(std::span<const drives::MotorCommand> wanted);
  void exchange(const drives::MotorCommand& wanted) { exchange(std::span(&wanted, 1)); }
  void exchange_off();
  /// The present positions become the drives' zeros; drives off. False: a protocol has no message for that.
  bool set_zero();

  /// At the motor's joint, or at its crank.
  drives::MotorReading reading(std::size_t motor = 0) const;

 private:
  struct Motor {
    Motor(const BusSetup& bus, const drives::MotorSetup& of)
        : setup(of),
          monitor(of.limits, bus.fresh_cycles()),
          channel(std::make_unique<drives::MotorChannel>(of, monitor, bus.data_bitrate != 0)) {}
    const drives::MotorSetup& setup;
    drives::MotorMonitor monitor;
    std::unique_ptr<drives::MotorChannel> channel;
  };
  void cycle(const std::function<void(std::size_t motor, bool synced, drives::Outbox&)>& ask);
  bool all(bool (drives::MotorMonitor::*is)() const noexcept) const;

  const BusSetup& bus_;
  std::vector<std::unique_ptr<Motor>> motors_;
  Link& link_;
  const std::function<void()>& tick_;
  std::function<void(const drives::Message&)> others_;
  std::unique_ptr<drives::Network> network_;  // of its bus; null: there is none
  int ticks_ = 0;                             // since its last sign of life
};

}  // namespace pmg::can
