#include "actuator/command_path.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

namespace {

Told told(const ActuatorInput& input) {
  return {input.q_rad, input.dq_rad_s, input.kp, input.kd, input.feed_forward_Nm};
}

}  // namespace

CommandPath::CommandPath(const model::ActuatorParameters::Command& parameters, double step_s)
    : parameters_(parameters),
      step_s_(step_s),
      delay_steps_(parameters.delay_s / step_s),
      delays_(parameters.delay_s > 0.0),
      limits_(std::isfinite(parameters.rate_limit_rad_s) || std::isfinite(parameters.acceleration_limit_rad_s2)),
      plain_(!delays_ && !limits_ && parameters.update_s <= step_s),
      update_(parameters.update_s, step_s) {}

void CommandPath::reset(double reading_rad) noexcept {
  told_before_ = false;
  command_rad_ = reading_rad;
  command_rad_s_ = 0.0;
  update_.restart();
}

void CommandPath::settle(const ActuatorInput& input) noexcept {
  if (delays_) past_.fill(told(input));
  told_before_ = true;
  command_rad_ = input.q_rad;
}

const ActuatorInput& CommandPath::stepped(const ActuatorInput& input) noexcept {
  Told now = told(input);
  if (delays_) now = delayed(now);
  if (!update_.every_step()) now = updated(now);
  command_rad_ = limits_ ? limited(now.q_rad) : now.q_rad;
  at_drive_ = input;
  at_drive_.q_rad = command_rad_;
  at_drive_.dq_rad_s = now.dq_rad_s;
  at_drive_.kp = now.kp;
  at_drive_.kd = now.kd;
  at_drive_.feed_forward_Nm = now.feed_forward_Nm;
  return at_drive_;
}

Told CommandPath::delayed(const Told& now) noexcept {
  if (!told_before_) {
    Told before = now;
    before.q_rad = command_rad_;
    past_.fill(before);
    told_before_ = true;
  }
  past_.push(now);
  return past_.at(delay_steps_);
}

Told CommandPath::updated(const Told& now) noexcept {
  if (update_.due()) taken_ = now;
  return taken_;
}

/// A limit of speed: command + clamp(q_command - command, -rate_limit h, rate_limit h). With a limit a of acceleration
/// the command goes on at the speed from which it can still brake, sqrt(2 a |q_command - command|).
double CommandPath::limited(double q_command_rad) noexcept {
  const double away_rad = q_command_rad - command_rad_;
  const double most_rad = parameters_.rate_limit_rad_s * step_s_;
  const double acceleration = parameters_.acceleration_limit_rad_s2;
  if (std::isinf(acceleration)) return command_rad_ + std::clamp(away_rad, -most_rad, most_rad);
  const double arrives_rad_s = std::abs(away_rad) / step_s_;
  const double brakes_rad_s = std::sqrt(2.0 * acceleration * std::abs(away_rad));
  const double wanted_rad_s =
      std::copysign(std::min({parameters_.rate_limit_rad_s, brakes_rad_s, arrives_rad_s}), away_rad);
  const double change_rad_s = acceleration * step_s_;
  command_rad_s_ += std::clamp(wanted_rad_s - command_rad_s_, -change_rad_s, change_rad_s);
  return command_rad_ + step_s_ * command_rad_s_;
}

}  // namespace pmg::actuator
