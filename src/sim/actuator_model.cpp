#include "sim/actuator_model.hpp"

#include <algorithm>
#include <cmath>

#include "actuator/checks.hpp"

namespace pmg::sim {

using actuator::TorqueLine;

namespace {

const model::ActuatorParameters& checked(const model::ActuatorParameters& parameters, double step_s) {
  actuator::expect_simulable(parameters, step_s);
  return parameters;
}

}  // namespace

ActuatorModel::ActuatorModel(const model::ActuatorParameters& parameters, double step_s)
    : parameters_(checked(parameters, step_s)),
      step_s_(step_s),
      armature_per_step_(parameters.transmission.armature_kg_m2 / step_s),
      elastic_(std::isfinite(parameters.transmission.stiffness_Nm_per_rad)),
      load_dependent_(parameters.friction.load_driving != 0.0 || parameters.friction.load_backdriving != 0.0),
      thermal_(parameters.thermal != model::ActuatorParameters::Thermal{}),
      sensor_turns_(elastic_ ? parameters.sensor.on_motor : 0.0),
      command_(parameters.command, step_s),
      sensor_(parameters.sensor, step_s),
      law_(parameters, step_s),
      motor_(parameters.drive, step_s),
      motor_friction_(parameters.friction, step_s),
      joint_friction_(parameters.friction, step_s),
      shaft_(parameters.transmission, step_s),
      warmth_(parameters.thermal, step_s),
      residual_(parameters.residual_torque, step_s) {
  reset(0.0);
}

void ActuatorModel::reset(double q_rad) noexcept {
  sensor_.reset(q_rad);
  command_.reset(sensor_.reading_rad(q_rad, 1.0));
  law_.reset();
  motor_.reset();
  motor_friction_.reset();
  joint_friction_.reset();
  shaft_.reset(q_rad);
  warmth_.reset();
  residual_.reset();
  drive_Nm_ = offset_Nm_ = transmitted_Nm_ = command_rad_ = error_rad_ = output_ = 0.0;
  given_ = {};
  given_at_rad_s_ = 0.0;
}

double ActuatorModel::sensed_rad(double q_rad) const noexcept {
  return sensor_turns_ == 0.0 ? q_rad : q_rad + sensor_turns_ * (shaft_.rotor_rad() - q_rad);
}

void ActuatorModel::wind(double q_rad, double load_Nm, double slack_rad) noexcept {
  shaft_.reset(q_rad, load_Nm, slack_rad);
  if (sensor_turns_ > 0.0) sensor_.reset(sensed_rad(q_rad));
}

void ActuatorModel::reset_at_rest(const ActuatorInput& input, double q_rad, double load_Nm, double slack_rad) noexcept {
  reset(q_rad);
  if (elastic_) wind(q_rad, load_Nm, slack_rad);
  command_.settle(input);
  if (thermal_) warmth_.take(input.temperature_C);
  const TorqueLine driven = drive(input, q_rad, 0.0, true);
  const double drive_Nm = driven.torque_Nm;
  if (residual_.acts()) {
    residual_.look(seen_by_residual(input, drive_Nm, elastic_ ? shaft_.rotor_rad() : q_rad, 0.0));
    rub_more();
  }
  const double by_angle_Nm = ripple(q_rad, driven).torque_Nm + residual_.torque().value_Nm;
  const double carried_Nm = load_Nm - drive_Nm - by_angle_Nm;  // by dry friction, whose parts share it
  const double direction = carried_Nm > 0.0 ? -1.0 : 1.0;
  transmitted_Nm_ = load_Nm;
  const double most_Nm = motor_friction_.most_dry_Nm(0.0, direction, friction_load_Nm(drive_Nm + by_angle_Nm, -load_Nm),
                                                     warmth_.friction().dry);
  if (std::abs(carried_Nm) > most_Nm) reset(q_rad);
  command_.restart_periods();
  sensor_.restart_periods();
  law_.restart_periods();
  motor_friction_.hold(carried_Nm, most_Nm);
  joint_friction_.hold(carried_Nm, most_Nm);
  given_.torque_Nm = transmitted_Nm_ = load_Nm;
  if (elastic_) {
    transmitted_Nm_ -= parameters_.transmission.friction_on_joint * std::clamp(carried_Nm, -most_Nm, most_Nm);
    wind(q_rad, transmitted_Nm_, slack_rad);
  }
}

double ActuatorModel::joint_armature_kg_m2() const { return elastic_ ? 0.0 : parameters_.transmission.armature_kg_m2; }

double ActuatorModel::reading_rad(double q_rad, double share_of_step) const {
  double angle_rad = q_rad;
  if (sensor_turns_ > 0.0) {
    const double rotor_rad = shaft_.rotor_rad() - (1.0 - share_of_step) * step_s_ * shaft_.rotor_rad_s();
    angle_rad += sensor_turns_ * (rotor_rad - q_rad);
  }
  return sensor_.reading_rad(angle_rad, share_of_step);
}

double ActuatorModel::joint_rad(const model::ActuatorParameters& parameters, double reading_rad, double load_Nm) {
  const double angle_rad = actuator::AngleSensor::angle_rad(parameters.sensor, reading_rad);
  if (parameters.sensor.on_motor == 0.0) return angle_rad;
  return angle_rad - parameters.sensor.on_motor * actuator::Shaft::twist_rad(parameters.transmission, load_Nm);
}

/// rests: the same input has been in force for a long time.
TorqueLine ActuatorModel::drive(const ActuatorInput& input, double q_rad, double dq_rad_s, bool rests) noexcept {
  const ActuatorInput& at_drive = command_.step(input);
  const actuator::Seen seen = sensor_.step(sensed_rad(q_rad), dq_rad_s);
  if (residual_.acts()) {
    command_rad_ = at_drive.q_rad;
    error_rad_ = at_drive.q_rad - seen.q_rad;
  }
  offset_Nm_ = input.enabled ? parameters_.drive.offset_Nm : 0.0;
  if (!input.enabled) return motor_.idle(dq_rad_s, warmth_.torque());
  const actuator::ControlLaw::Output output = law_.step(at_drive, seen, sensor_.prompt_speed());
  if (residual_.acts()) output_ = output.value;
  if (rests)
    motor_.settle(output.value);
  else if (motor_.needs_past())
    motor_.settle(law_.standing_output());
  TorqueLine driven = motor_.step(output, input.supply, dq_rad_s, warmth_.torque());
  driven.torque_Nm += offset_Nm_;
  return driven;
}

/// offset + (amplitude + torque_share driven) sin(order q + phase) + second sin(2 order q + second_phase) -
/// spring q.
TorqueLine ActuatorModel::ripple(double motor_rad, const TorqueLine& driven) const noexcept {
  const model::ActuatorParameters::Ripple& p = parameters_.ripple;
  const double still_Nm = p.offset_Nm - p.spring_Nm_per_rad * motor_rad;
  if (p.amplitude_Nm == 0.0 && p.torque_share == 0.0 && p.second_Nm == 0.0) return {still_Nm, 0.0};
  const double wave = std::sin(p.order * motor_rad + p.phase_rad);
  const double second_Nm =
      p.second_Nm == 0.0 ? 0.0 : p.second_Nm * std::sin(2.0 * p.order * motor_rad + p.second_phase_rad);
  return {still_Nm + (p.amplitude_Nm + p.torque_share * driven.torque_Nm) * wave + second_Nm,
          p.torque_share * driven.slope_Nm_s_per_rad * wave};
}

/// After drive(), whose torque and error it takes.
actuator::ResidualSeen ActuatorModel::seen_by_residual(const ActuatorInput& input, double drive_Nm, double motor_rad,
                                                       double motor_rad_s) const noexcept {
  const model::ActuatorParameters::Drive& p = parameters_.drive;
  return {.motor_rad = motor_rad,
          .motor_rad_s = motor_rad_s,
          .command_rad = command_rad_,
          .error_rad = error_rad_,
          .stiffness_Nm_per_rad = p.torque_per_unit_Nm * input.supply * p.kp_scale * input.kp,
          .drive_Nm = drive_Nm,
          .temperature_C = input.temperature_C,
          .integrates = input.enabled && std::abs(output_) < p.limit,
          .enabled = input.enabled,
          .sticks = motor_friction_.sticks()};
}

void ActuatorModel::rub_more() noexcept {
  const actuator::GearFriction::More more{residual_.friction().value_Nm, residual_.friction().slope};
  motor_friction_.add(more);
  joint_friction_.add(more);
}

/// transmitted + load_by_motor (motor - transmitted) + load_net ((motor - external) / 2 - transmitted).
double ActuatorModel::friction_load_Nm(double motor_Nm, double external_Nm) const noexcept {
  if (!load_dependent_) return 0.0;
  const model::ActuatorParameters::Friction& p = parameters_.friction;
  return transmitted_Nm_ + p.load_by_motor * (motor_Nm - transmitted_Nm_) +
         p.load_net * (0.5 * (motor_Nm - external_Nm) - transmitted_Nm_);
}

ActuatorTorque ActuatorModel::step(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept {
  const double motor_rad_s = elastic_ ? shaft_.rotor_rad_s() : dq_rad_s;
  const double motor_rad = elastic_ ? shaft_.rotor_rad() : q_rad;
  if (load_dependent_ && !elastic_) {
    const double change_rad_s = dq_rad_s - given_at_rad_s_;
    transmitted_Nm_ = given_.torque_Nm + (given_.slope_Nm_s_per_rad - armature_per_step_) * change_rad_s;
  }
  if (thermal_) warmth_.take(input.temperature_C);
  const TorqueLine driven = drive(input, q_rad, motor_rad_s, false);
  drive_Nm_ = driven.torque_Nm;
  motor_friction_.bend(motor_rad_s);
  if (residual_.acts()) {
    residual_.follow(seen_by_residual(input, drive_Nm_, motor_rad, motor_rad_s));
    rub_more();
  }
  const TorqueLine rippled = ripple(motor_rad, driven);
  const double by_angle_Nm = rippled.torque_Nm + residual_.torque().value_Nm;
  const double load_Nm = friction_load_Nm(drive_Nm_ + by_angle_Nm, input.external_Nm);
  const TorqueLine friction = motor_friction_.torque(motor_rad_s, load_Nm, warmth_.friction());
  TorqueLine motor{
      driven.torque_Nm + friction.torque_Nm + by_angle_Nm,
      driven.slope_Nm_s_per_rad + rippled.slope_Nm_s_per_rad + friction.slope_Nm_s_per_rad + residual_.torque().slope};
  if (elastic_ && parameters_.transmission.friction_on_joint > 0.0) {
    motor = rubbed_on_joint(motor, friction, load_Nm, q_rad, dq_rad_s);
  } else {
    if (thermal_) warmth_.pass(drive_Nm_, -friction.torque_Nm * motor_rad_s);
    if (elastic_) motor = shaft_.step(motor, q_rad, dq_rad_s), transmitted_Nm_ = motor.torque_Nm;
  }
  given_.torque_Nm = motor.torque_Nm;
  given_.slope_Nm_s_per_rad = motor.slope_Nm_s_per_rad;
  given_at_rad_s_ = dq_rad_s;
  return {motor.torque_Nm, motor.slope_Nm_s_per_rad};
}

/// Friction's share on the joint's side acts behind the shaft.
TorqueLine ActuatorModel::rubbed_on_joint(TorqueLine motor, TorqueLine friction, double load_Nm, double q_rad,
                                          double dq_rad_s) noexcept {
  const double share = parameters_.transmission.friction_on_joint, motor_rad_s = shaft_.rotor_rad_s();
  motor.torque_Nm -= share * friction.torque_Nm;
  motor.slope_Nm_s_per_rad -= share * friction.slope_Nm_s_per_rad;
  const TorqueLine shaft = shaft_.step(motor, q_rad, dq_rad_s);
  transmitted_Nm_ = shaft.torque_Nm;
  joint_friction_.bend(dq_rad_s);
  const TorqueLine joint = joint_friction_.torque(dq_rad_s, load_Nm, warmth_.friction());
  if (thermal_) {
    warmth_.pass(drive_Nm_, -(1.0 - share) * friction.torque_Nm * motor_rad_s - share * joint.torque_Nm * dq_rad_s);
  }
  return {shaft.torque_Nm + share * joint.torque_Nm, shaft.slope_Nm_s_per_rad + share * joint.slope_Nm_s_per_rad};
}

}  // namespace pmg::sim
