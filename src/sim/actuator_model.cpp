// One actuator, its stages in the order in which a command passes them. Longer than 300 lines for that.
#include "sim/actuator_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pmg::sim {

namespace {

void expect(bool holds, const char* text) {
  if (!holds) throw std::invalid_argument(text);
}

}  // namespace

ActuatorModel::ActuatorModel(const model::ActuatorParameters& parameters, double step_s)
    : parameters_(parameters),
      step_s_(step_s),
      elastic_(std::isfinite(parameters.transmission.stiffness_Nm_per_rad)),
      lagging_(parameters.sensor.lag_s > 0.0),
      velocity_lagging_(parameters.sensor.velocity_lag_s > 0.0),
      delaying_(parameters.command.delay_s > 0.0),
      rate_limited_(std::isfinite(parameters.command.rate_limit_rad_s)),
      torque_speed_(std::isfinite(parameters.drive.stall_torque_Nm)),
      load_dependent_(parameters.friction.load_driving != 0.0 || parameters.friction.load_backdriving != 0.0),
      thermal_(parameters.thermal != model::ActuatorParameters::Thermal{}) {
  expect(step_s > 0.0, "an actuator's step isn't above 0");
  const auto& [command, drive, sensor, transmission, friction, thermal, ripple] = parameters_;
  if (command.delay_s < 0.0 || command.delay_s > kDelaySteps * step_s) {
    throw std::invalid_argument("a delay of " + std::to_string(command.delay_s) + " s; expected at most " +
                                std::to_string(kDelaySteps) + " steps");
  }
  expect(command.rate_limit_rad_s > 0.0, "a rate limit isn't above 0");
  expect(std::abs(sensor.eccentricity_rad) < 1.0,
         "an eccentricity of a radian or more; expected a reading that grows with q");
  expect(thermal.cooling_s > 0.0, "thermal.cooling_s isn't above 0");
  expect(friction.presliding_rad > 0.0, "friction.presliding_rad isn't above 0");
  expect(friction.stribeck_rad_s > 0.0, "friction.stribeck_rad_s isn't above 0");
  expect(drive.no_load_rad_s > 0.0, "drive.no_load_rad_s isn't above 0");
  expect(!elastic_ || transmission.armature_kg_m2 > 0.0, "a rotor behind a spring needs an armature");
  expect(elastic_ || (transmission.backlash_rad == 0.0 && transmission.damping_Nm_s_per_rad == 0.0),
         "backlash and shaft damping need a transmission.stiffness_Nm_per_rad");
  reset(0.0);
}

void ActuatorModel::reset(double q_rad) noexcept {
  sensor_rad_ = q_rad;
  const double reading = reading_rad(q_rad);
  told_before_ = false;
  newest_ = 0;
  command_rad_ = lagged_rad_ = sensed_before_rad_ = reading;
  held_for_s_ = parameters_.command.hold_s - step_s_;
  held_output_ = bristle_rad_ = load_Nm_ = 0.0;
  rotor_rad_ = q_rad;
  rotor_rad_s_ = lagged_rad_s_ = 0.0;
  given_ = {};
  given_at_rad_s_ = 0.0;
  heat_Nm2_s_ = drive_Nm_ = 0.0;
  temperature_C_ = model::kReferenceTemperature_C;
  friction_factor_ = torque_factor_ = 1.0;
}

void ActuatorModel::reset_at_rest(const ActuatorInput& input, double q_rad, double load_Nm) noexcept {
  reset(q_rad);
  const ActuatorModel stepped = *this;
  past_.fill({input.q_rad, input.dq_rad_s, input.kp, input.kd, input.feed_forward_Nm});
  told_before_ = true;
  command_rad_ = input.q_rad;
  if (thermal_) warm(input.temperature_C);
  const double carried_Nm = load_Nm - drive(input, q_rad, 0.0).torque_Nm - ripple_Nm(q_rad);  // by dry friction
  load_Nm_ = load_Nm;
  const double direction = carried_Nm > 0.0 ? -1.0 : 1.0;
  const double most_Nm = most_dry_friction_Nm(0.0, direction);
  if (std::abs(carried_Nm) > most_Nm) *this = stepped;
  held_for_s_ = stepped.held_for_s_;
  if (most_Nm > 0.0) {
    bristle_rad_ = direction * parameters_.friction.presliding_rad * std::min(1.0, std::abs(carried_Nm) / most_Nm);
  }
  load_Nm_ = given_.torque_Nm = load_Nm;
  if (elastic_ && load_Nm != 0.0) {
    const double half_play_rad = 0.5 * parameters_.transmission.backlash_rad;
    rotor_rad_ += load_Nm / parameters_.transmission.stiffness_Nm_per_rad + std::copysign(half_play_rad, load_Nm);
  }
}

double ActuatorModel::joint_armature_kg_m2() const { return elastic_ ? 0.0 : parameters_.transmission.armature_kg_m2; }

/// The play operator: the sensor stays until the joint takes it along.
double ActuatorModel::followed(double q_rad) const noexcept {
  const double half_rad = 0.5 * parameters_.sensor.hysteresis_rad;
  return half_rad > 0.0 ? std::clamp(sensor_rad_, q_rad - half_rad, q_rad + half_rad) : q_rad;
}

double ActuatorModel::reading_rad(double q_rad) const {
  const model::ActuatorParameters::Sensor& p = parameters_.sensor;
  const double seen_rad = followed(q_rad);
  double reading = seen_rad + p.zero_offset_rad;
  if (p.eccentricity_rad != 0.0) reading += p.eccentricity_rad * std::sin(seen_rad + p.eccentricity_phase_rad);
  const double quantum = p.quantum_rad;
  return quantum > 0.0 ? quantum * std::round(reading / quantum) : reading;
}

/// Solves q + e sin(q + phase) = reading - offset by Newton's method; |e| < 1, so the slope is above 0.
double ActuatorModel::joint_rad(const model::ActuatorParameters::Sensor& sensor, double reading_rad) {
  const double shown_rad = reading_rad - sensor.zero_offset_rad;
  if (sensor.eccentricity_rad == 0.0) return shown_rad;
  double q_rad = shown_rad;
  for (int i = 0; i < 20; ++i) {
    const double miss_rad =
        q_rad + sensor.eccentricity_rad * std::sin(q_rad + sensor.eccentricity_phase_rad) - shown_rad;
    q_rad -= miss_rad / (1.0 + sensor.eccentricity_rad * std::cos(q_rad + sensor.eccentricity_phase_rad));
  }
  return q_rad;
}

/// Interpolates linearly between two stored commands. The result is the mean of a held command over the step, and
/// smooth in the delay.
ActuatorModel::Told ActuatorModel::delayed(const Told& now) noexcept {
  constexpr int kSize = kDelaySteps + 2;
  if (!told_before_) {
    Told before = now;
    before.q_rad = command_rad_;
    past_.fill(before);
    told_before_ = true;
  }
  newest_ = newest_ + 1 == kSize ? 0 : newest_ + 1;
  past_[static_cast<std::size_t>(newest_)] = now;
  const double steps = parameters_.command.delay_s / step_s_;
  const int whole = static_cast<int>(steps);
  const double share = steps - whole;
  int later = newest_ - whole;
  if (later < 0) later += kSize;
  const Told& a = past_[static_cast<std::size_t>(later)];
  const Told& b = past_[static_cast<std::size_t>(later == 0 ? kSize - 1 : later - 1)];
  const auto between = [share](double x, double y) { return x + share * (y - x); };
  return {between(a.q_rad, b.q_rad), between(a.dq_rad_s, b.dq_rad_s), between(a.kp, b.kp), between(a.kd, b.kd),
          between(a.feed_forward_Nm, b.feed_forward_Nm)};
}

/// command + clamp(q_command - command, -rate_limit h, rate_limit h).
double ActuatorModel::limited(double q_command_rad) noexcept {
  const double most = parameters_.command.rate_limit_rad_s * step_s_;
  return command_rad_ + std::clamp(q_command_rad - command_rad_, -most, most);
}

/// First-order lag, implicit Euler: lagged += h / (lag + h) (reading - lagged).
double ActuatorModel::sensed(double q_rad) noexcept {
  sensor_rad_ = followed(q_rad);
  const double reading = reading_rad(q_rad);
  if (!lagging_) return reading;
  lagged_rad_ += step_s_ / (parameters_.sensor.lag_s + step_s_) * (reading - lagged_rad_);
  return lagged_rad_;
}

double ActuatorModel::sensed_velocity(double dq_rad_s) noexcept {
  if (!velocity_lagging_) return dq_rad_s;
  lagged_rad_s_ += step_s_ / (parameters_.sensor.velocity_lag_s + step_s_) * (dq_rad_s - lagged_rad_s_);
  return lagged_rad_s_;
}

ActuatorModel::Line ActuatorModel::drive(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept {
  const model::ActuatorParameters::Drive& p = parameters_.drive;
  Told told{input.q_rad, input.dq_rad_s, input.kp, input.kd, input.feed_forward_Nm};
  if (delaying_) told = delayed(told);
  command_rad_ = rate_limited_ ? limited(told.q_rad) : told.q_rad;
  const double q_sensed_rad = sensed(q_rad);
  const double dq_sensed_rad_s = sensed_velocity(lagging_ ? (q_sensed_rad - sensed_before_rad_) / step_s_ : dq_rad_s);
  sensed_before_rad_ = q_sensed_rad;
  if (input.enabled) return powered(told, input.supply, q_sensed_rad, dq_sensed_rad_s, dq_rad_s);
  const double brake = p.brake_when_disabled * p.torque_per_unit_Nm * torque_factor_ * p.back_emf_s_per_rad;
  return {-brake * dq_rad_s, -brake};
}

/// The term x = sag duty^2 F of a supply with a source resistance. A bridge takes duty times the motor's current from
/// the bus. With the torque T and F = unit supply, the torque at full duty:
///   T = unit (supply (1 - sag duty T) duty - back_emf dq) = unit (supply duty - back_emf dq) / (1 + x).
/// So the motor sees duty^2 of the source's resistance. A braking motor feeds the bus.
double ActuatorModel::sag(double full_Nm) const noexcept {
  const double duty = held_output_ / parameters_.drive.limit;  // 0 without a limit: such a drive regulates its current
  return parameters_.drive.supply_sag_per_Nm * full_Nm * duty * duty;
}

ActuatorModel::Line ActuatorModel::powered(const Told& told, double supply, double q_sensed_rad, double dq_sensed_rad_s,
                                           double dq_rad_s) noexcept {
  const model::ActuatorParameters::Drive& p = parameters_.drive;
  double per_unit_Nm = p.torque_per_unit_Nm * torque_factor_;
  const double kd = p.kd_scale * told.kd;
  bool follows_speed = !lagging_ && !velocity_lagging_;
  held_for_s_ += step_s_;
  if (held_for_s_ >= parameters_.command.hold_s - 1e-9) {
    held_for_s_ = std::min(held_for_s_ - parameters_.command.hold_s, step_s_);
    double error_rad = command_rad_ - q_sensed_rad;
    if (std::abs(error_rad) < p.dead_band_rad) error_rad = 0.0;
    // Newton metres are newton metres under every law: the drive divides them by its torque constant (that of the
    // reference temperature, because it does not know its winding's) and by its supply.
    const double forward = told.feed_forward_Nm / (p.torque_per_unit_Nm * supply);
    const double wish = p.kp_scale * told.kp * error_rad + kd * (told.dq_rad_s - dq_sensed_rad_s) + forward;
    held_output_ = std::clamp(wish, -p.limit, p.limit);
    follows_speed = follows_speed && held_output_ == wish && parameters_.command.hold_s <= step_s_;
  } else {
    follows_speed = false;
  }
  if (p.supply_sag_per_Nm > 0.0) per_unit_Nm /= 1.0 + sag(per_unit_Nm * supply);
  const double scale = per_unit_Nm * supply;
  Line motor{scale * held_output_ - per_unit_Nm * p.back_emf_s_per_rad * dq_rad_s,
             -per_unit_Nm * p.back_emf_s_per_rad - (follows_speed ? scale * kd : 0.0)};
  if (!torque_speed_) return motor;
  const double along = motor.torque_Nm >= 0.0 ? 1.0 : -1.0;
  const double available_Nm =
      std::clamp(p.stall_torque_Nm * (1.0 - along * dq_rad_s / p.no_load_rad_s), 0.0, p.stall_torque_Nm);
  if (along * motor.torque_Nm <= available_Nm) return motor;
  const bool on_slope = available_Nm > 0.0 && available_Nm < p.stall_torque_Nm;
  return {along * available_Nm, on_slope ? -p.stall_torque_Nm / p.no_load_rad_s : 0.0};
}

/// Largest dry friction at the speed dq, for a motion in this direction (1 or -1):
///   (coulomb + stribeck exp(-(dq / stribeck_rad_s)^2) + load factor |torque through the gear|)
///   * thermal factor * (1 + asymmetry direction).
double ActuatorModel::most_dry_friction_Nm(double dq_rad_s, double direction) const noexcept {
  const model::ActuatorParameters::Friction& p = parameters_.friction;
  double most_Nm = p.coulomb_Nm;
  if (p.stribeck_Nm != 0.0) {
    const double ratio = dq_rad_s / p.stribeck_rad_s;
    most_Nm += p.stribeck_Nm * std::exp(-ratio * ratio);
  }
  if (load_dependent_) {
    most_Nm += (load_Nm_ * direction > 0.0 ? p.load_driving : p.load_backdriving) * std::abs(load_Nm_);
  }
  return most_Nm * friction_factor_ * (1.0 + p.asymmetry * direction);
}

/// -most_dry_friction * clamp(bend / presliding, -1, 1) with the bristle's bend at the end of the step.
ActuatorModel::Line ActuatorModel::dry_friction(double dq_rad_s) const noexcept {
  const double presliding_rad = parameters_.friction.presliding_rad;
  const double bend_rad = bristle_rad_ + step_s_ * dq_rad_s;
  const double direction = bend_rad >= 0.0 ? 1.0 : -1.0;
  const double most_Nm = most_dry_friction_Nm(dq_rad_s, direction);
  if (std::abs(bend_rad) >= presliding_rad) return {-direction * most_Nm, 0.0};
  const double stiffness = most_Nm / presliding_rad;
  return {-stiffness * bend_rad, -stiffness * step_s_};
}

/// offset + amplitude sin(order q + phase).
double ActuatorModel::ripple_Nm(double motor_rad) const noexcept {
  const model::ActuatorParameters::Ripple& p = parameters_.ripple;
  if (p.amplitude_Nm == 0.0) return p.offset_Nm;
  return p.offset_Nm + p.amplitude_Nm * std::sin(p.order * motor_rad + p.phase_rad);
}

/// With the heat H and the temperature T:
///   H += h (torque^2 - H / cooling),
///   friction factor = exp(friction_per_K (T - 25 degC) + friction_per_Nm2_s H),
///   torque factor = 1 + torque_per_K (T - 25 degC), at least 0.
void ActuatorModel::warm(double temperature_C) noexcept {
  const model::ActuatorParameters::Thermal& p = parameters_.thermal;
  const bool heats = p.friction_per_Nm2_s != 0.0;
  if (!heats && temperature_C == temperature_C_) return;  // exp() only when the reading changes, not in every step
  if (heats) heat_Nm2_s_ += step_s_ * (drive_Nm_ * drive_Nm_ - heat_Nm2_s_ / p.cooling_s);
  temperature_C_ = temperature_C;
  const double above_K = temperature_C - model::kReferenceTemperature_C;
  friction_factor_ = std::exp(p.friction_per_K * above_K + p.friction_per_Nm2_s * heat_Nm2_s_);
  torque_factor_ = std::max(0.0, 1.0 + p.torque_per_K * above_K);
}

ActuatorTorque ActuatorModel::step(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept {
  const double motor_rad_s = elastic_ ? rotor_rad_s_ : dq_rad_s;
  const double motor_rad = elastic_ ? rotor_rad_ : q_rad;
  const double most_rad = parameters_.friction.presliding_rad;
  bristle_rad_ = std::clamp(bristle_rad_ + step_s_ * motor_rad_s, -most_rad, most_rad);
  if (load_dependent_ && !elastic_) {
    const double change_rad_s = dq_rad_s - given_at_rad_s_;
    load_Nm_ = given_.torque_Nm +
               (given_.slope_Nm_s_per_rad - parameters_.transmission.armature_kg_m2 / step_s_) * change_rad_s;
  }
  if (thermal_) warm(input.temperature_C);
  Line motor = drive(input, q_rad, motor_rad_s);
  drive_Nm_ = motor.torque_Nm;
  const Line dry = dry_friction(motor_rad_s);
  const double viscous = friction_factor_ * parameters_.friction.viscous_Nm_s_per_rad;
  motor.torque_Nm += dry.torque_Nm - viscous * motor_rad_s;
  motor.slope += dry.slope - viscous;
  motor.torque_Nm += ripple_Nm(motor_rad);
  given_ = elastic_ ? elastic(motor, q_rad, dq_rad_s) : ActuatorTorque{motor.torque_Nm, motor.slope};
  given_at_rad_s_ = dq_rad_s;
  return given_;
}

/// First the rotor moves, against a shaft whose joint end keeps its speed:
///   w' = w + (motor - shaft) / (J / h - motor slope + shaft slope).
/// Then the shaft's torque at w' acts on the joint. Both are implicit in their own speed, so a stiff shaft stays
/// stable.
ActuatorTorque ActuatorModel::elastic(const Line& motor, double q_rad, double dq_rad_s) noexcept {
  const model::ActuatorParameters::Transmission& p = parameters_.transmission;
  const double half_play_rad = 0.5 * p.backlash_rad;
  const auto wound_rad = [&](double twist_rad) {
    return twist_rad - std::clamp(twist_rad, -half_play_rad, half_play_rad);
  };
  const auto shaft = [&](double rotor_rad,
                         double rotor_rad_s) -> Line {  // on the joint; the slope is in the relative speed
    const double relative_rad_s = rotor_rad_s - dq_rad_s;
    const double wound = wound_rad(rotor_rad - q_rad + step_s_ * relative_rad_s);
    if (wound == 0.0) return {0.0, 0.0};
    return {p.stiffness_Nm_per_rad * wound + p.damping_Nm_s_per_rad * relative_rad_s,
            p.stiffness_Nm_per_rad * step_s_ + p.damping_Nm_s_per_rad};
  };
  const Line before = shaft(rotor_rad_, rotor_rad_s_);
  rotor_rad_s_ += (motor.torque_Nm - before.torque_Nm) / (p.armature_kg_m2 / step_s_ - motor.slope + before.slope);
  const double old_rotor_rad = rotor_rad_;
  rotor_rad_ += step_s_ * rotor_rad_s_;
  const Line after = shaft(old_rotor_rad, rotor_rad_s_);
  load_Nm_ = after.torque_Nm;
  return {after.torque_Nm, -after.slope};
}

}  // namespace pmg::sim
