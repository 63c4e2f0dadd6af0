// A command's way to the drive's comparison: delay, update period, limits of speed and acceleration.
#pragma once

#include "actuator/actuator_input.hpp"
#include "actuator/delay_line.hpp"
#include "actuator/period.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

/// The part of ActuatorInput that travels.
struct Told {
  double q_rad, dq_rad_s, kp, kd, feed_forward_Nm;
};

inline Told between(const Told& a, const Told& b, double share) noexcept {
  return {between(a.q_rad, b.q_rad, share), between(a.dq_rad_s, b.dq_rad_s, share), between(a.kp, b.kp, share),
          between(a.kd, b.kd, share), between(a.feed_forward_Nm, b.feed_forward_Nm, share)};
}

class CommandPath {
 public:
  CommandPath(const model::ActuatorParameters::Command& parameters, double step_s);

  /// Commands before the first step count as equal to its command, but with the joint's reading as position.
  void reset(double reading_rad) noexcept;

  /// As if this had been commanded for a long time.
  void settle(const ActuatorInput& input) noexcept;

  /// (what the drive is told now) => (what it compares with its sensor in this step). Refers to the argument or to this
  /// object.
  const ActuatorInput& step(const ActuatorInput& input) noexcept { return plain_ ? input : stepped(input); }

  void restart_periods() noexcept { update_.restart(); }

 private:
  const ActuatorInput& stepped(const ActuatorInput& input) noexcept;
  Told delayed(const Told& now) noexcept;
  Told updated(const Told& now) noexcept;
  double limited(double q_command_rad) noexcept;

  model::ActuatorParameters::Command parameters_;
  double step_s_, delay_steps_;
  bool delays_, limits_, plain_;
  DelayLine<Told> past_;
  bool told_before_ = false;
  Period update_;
  Told taken_{};
  ActuatorInput at_drive_;
  double command_rad_ = 0.0, command_rad_s_ = 0.0;
};

}  // namespace pmg::actuator
