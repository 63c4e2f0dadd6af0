#include "actuator/motor_torque.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

namespace {

constexpr double kCutShare = 0.1;  // of the speed, over which an overspeed guard takes all torque away

/// No more than most_Nm along the torque's direction, whose derivative by speed is then `slope`.
TorqueLine capped(const TorqueLine& motor, double along, double most_Nm, double slope) {
  return along * motor.torque_Nm <= most_Nm ? motor : TorqueLine{along * most_Nm, slope};
}

}  // namespace

MotorTorque::MotorTorque(const model::ActuatorParameters::Drive& parameters, double step_s)
    : parameters_(parameters),
      step_s_(step_s),
      delay_steps_(parameters.torque_delay_s / step_s),
      unit_Nm_(parameters.torque_per_unit_Nm * parameters.torque_scale),
      delays_(parameters.torque_delay_s > 0.0),
      output_rate_limited_(std::isfinite(parameters.output_rate_limit_per_s)),
      sags_(parameters.supply_sag_per_Nm > 0.0),
      sags_slowly_(sags_ && parameters.supply_sag_time_s > 0.0),
      supply_limited_(std::isfinite(parameters.supply_limit_Nm)),
      power_limited_(std::isfinite(parameters.most_power_W)),
      speed_cut_(std::isfinite(parameters.cut_speed_rad_s)),
      limits_(parameters.saturation_per_Nm > 0.0 || supply_limited_ || std::isfinite(parameters.stall_torque_Nm) ||
              power_limited_ || speed_cut_),
      plain_(!delays_ && !output_rate_limited_ && !sags_ && !limits_) {}

void MotorTorque::reset() noexcept {
  given_before_ = false;
  given_ = bus_lost_ = 0.0;
}

void MotorTorque::settle(double output) noexcept {
  if (delays_) past_.fill(output);
  given_ = output;
  given_before_ = true;
}

/// The output after its delay and within the limit of its rate.
ControlLaw::Output MotorTorque::late(ControlLaw::Output output) noexcept {
  if (delays_) {
    past_.push(output.value);
    output.value = past_.at(delay_steps_);
    output.speed_gain *= share_within_step(delay_steps_);
  }
  if (output_rate_limited_) {
    const double most = parameters_.output_rate_limit_per_s * step_s_;
    const double wish = output.value;
    output.value = given_ + std::clamp(wish - given_, -most, most);
    if (output.value != wish) output.speed_gain = 0.0;
  }
  given_ = output.value;
  return output;
}

/// A supply with a source resistance: a bridge takes duty times the motor's current from the bus. With the torque T and
/// F = unit supply, the torque at full duty:
///   T = unit (supply (1 - lost - sag duty T) duty - back_emf dq) = unit (supply (1 - lost) duty - back_emf dq) /
///       (1 + sag F duty^2).
/// So the motor sees duty^2 of the source's resistance. A braking motor feeds the bus. Of a battery, supply_sag_slow of
/// the resistance acts through a capacitance:
///   d lost / dt = (slow sag duty T - lost) / supply_sag_time.
TorqueLine MotorTorque::stepped(ControlLaw::Output output, double supply, double dq_rad_s,
                                double torque_factor) noexcept {
  const model::ActuatorParameters::Drive& p = parameters_;
  if (delays_ || output_rate_limited_) output = late(output);
  double per_unit_Nm = unit_Nm_ * torque_factor;
  const double full_Nm = per_unit_Nm * supply;
  // Without a limit of the output there is no duty: such a drive regulates its current.
  const double duty = sags_ || supply_limited_ ? output.value / p.limit : 0.0;
  const double slow = sags_slowly_ ? p.supply_sag_slow_share : 0.0;
  if (sags_) per_unit_Nm /= 1.0 + (1.0 - slow) * p.supply_sag_per_Nm * full_Nm * duty * duty;
  const double scale = sags_slowly_ ? per_unit_Nm * supply * (1.0 - bus_lost_) : per_unit_Nm * supply;
  TorqueLine motor{scale * output.value - per_unit_Nm * p.back_emf_s_per_rad * dq_rad_s,
                   -per_unit_Nm * p.back_emf_s_per_rad - scale * output.speed_gain};
  if (limits_) motor = limited(motor, duty, full_Nm, dq_rad_s);
  if (sags_slowly_) {
    const double lost = slow * p.supply_sag_per_Nm * duty * motor.torque_Nm;
    bus_lost_ += step_s_ / (p.supply_sag_time_s + step_s_) * (lost - bus_lost_);
  }
  return motor;
}

/// In this order, with w the speed along the torque:
///   saturation of the core:            T / (1 + saturation |T|)
///   current limit of the supply:       T duty <= supply_limit, while the motor takes from the bus
///   torque-speed line:                 T <= stall (1 - w / no_load)
///   power limit, field weakening:      T <= most_power / w
///   guard against overspeed:           T <= limit (cut - w) / (0.1 cut), with limit the torque at the output's limit.
TorqueLine MotorTorque::limited(TorqueLine motor, double duty, double full_Nm, double dq_rad_s) const noexcept {
  const model::ActuatorParameters::Drive& p = parameters_;
  const double along = motor.torque_Nm >= 0.0 ? 1.0 : -1.0, along_rad_s = along * dq_rad_s;
  if (p.saturation_per_Nm > 0.0) {
    const double kept = 1.0 / (1.0 + p.saturation_per_Nm * std::abs(motor.torque_Nm));
    motor = {motor.torque_Nm * kept, motor.slope_Nm_s_per_rad * kept * kept};
  }
  if (supply_limited_ && along * duty > 0.0) motor = capped(motor, along, p.supply_limit_Nm / std::abs(duty), 0.0);
  if (std::isfinite(p.stall_torque_Nm)) {
    const double available_Nm =
        std::clamp(p.stall_torque_Nm * (1.0 - along_rad_s / p.no_load_rad_s), 0.0, p.stall_torque_Nm);
    const bool on_slope = available_Nm > 0.0 && available_Nm < p.stall_torque_Nm;
    motor = capped(motor, along, available_Nm, on_slope ? -p.stall_torque_Nm / p.no_load_rad_s : 0.0);
  }
  if (power_limited_ && along_rad_s > 0.0) {
    const double available_Nm = p.most_power_W / along_rad_s;
    motor = capped(motor, along, available_Nm, -available_Nm / along_rad_s);
  }
  const double share = speed_cut_ ? (1.0 - along_rad_s / p.cut_speed_rad_s) / kCutShare : 1.0;
  if (share < 1.0) {
    const double most_Nm = std::isfinite(p.limit) ? full_Nm * p.limit : along * motor.torque_Nm;
    motor = capped(motor, along, most_Nm * std::max(0.0, share),
                   share > 0.0 ? -most_Nm / (kCutShare * p.cut_speed_rad_s) : 0.0);
  }
  return motor;
}

/// The share brake_when_disabled of the back-EMF's torque stays.
TorqueLine MotorTorque::idle(double dq_rad_s, double torque_factor) noexcept {
  if (delays_ || output_rate_limited_) settle(0.0);
  const model::ActuatorParameters::Drive& p = parameters_;
  const double brake = p.brake_when_disabled * unit_Nm_ * torque_factor * p.back_emf_s_per_rad;
  return {-brake * dq_rad_s, -brake};
}

double MotorTorque::believed_Nm(double torque_Nm) const noexcept {
  return torque_Nm / (1.0 - parameters_.saturation_per_Nm * std::abs(torque_Nm)) / parameters_.torque_scale;
}

}  // namespace pmg::actuator
