// One motor of a bus, driven alone, the others switched off. It goes at the pace of its answers: an ordinary computer
// or a slow adapter may bring one 10 ms late.
#pragma once

#include <functional>
#include <memory>

#include "can/bus_setup.hpp"
#include "can/canopen_setup.hpp"
#include "can/link.hpp"
#include "drives/motor_channel.hpp"

namespace pmg::can {

class OneMotor {
 public:
  /// Sets a CANopen drive up and waits for the first answer, drive off. tick is called every 2 ms and waits; emulators
  /// answer in it. others: gets what isn't the motor's; empty: nobody wants to know. Throws std::runtime_error: the
  /// motor doesn't answer, or its drive isn't as robot.yaml has it. Keeps references.
  OneMotor(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const std::function<void()>& tick,
           std::function<void(const drives::Message&)> others = {});
  ~OneMotor();  ///< switches it off
  OneMotor(const OneMotor&) = delete;
  OneMotor& operator=(const OneMotor&) = delete;

  /// Switches the drive on without stiffness. False: it doesn't follow within 0.5 s.
  bool switch_on();
  /// One bus cycle. Throws std::runtime_error when the motor is in trouble.
  void exchange(const drives::MotorCommand& joint);
  void exchange_off();
  /// The present position becomes the drive's zero; drive off. False: its protocol has no message for that.
  bool set_zero();

  drives::MotorReading joint() const { return setup_.transmission.to_joint(monitor_.reading()); }
  const drives::MotorChannel& motor() const { return motor_; }

 private:
  void cycle(const std::function<void(bool synced, drives::Outbox&)>& ask);

  const BusSetup& bus_;
  const drives::MotorSetup& setup_;
  drives::MotorMonitor monitor_;
  drives::MotorChannel motor_;
  Link& link_;
  const std::function<void()>& tick_;
  std::function<void(const drives::Message&)> others_;
  std::unique_ptr<drives::Network> network_;  // of its bus; null: there is none
  int ticks_ = 0;                             // since its last sign of life
};

}  // namespace pmg::can
