#include "model/actuator_parameters.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/nearest_name.hpp"

namespace pmg::model {

namespace {

#define PMG_ACTUATOR_PARAMETER(group, key, quantity, lower, upper, negative) \
  ActuatorParameter {                                                        \
#group "." #key, Quantity::quantity, lower, upper, negative,             \
        [](ActuatorParameters & p) -> double& { return p.group.key; }        \
  }

// The ranges cover joints from a hobby servo's to a humanoid's knee; a linear rig scales them.
constexpr std::array kParameters = {
    PMG_ACTUATOR_PARAMETER(command, delay_s, kDelay, 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(command, update_s, kPeriod, 0.0, 0.2, false),
    PMG_ACTUATOR_PARAMETER(command, rate_limit_rad_s, kSpeed, 1.0, 30.0, false),
    PMG_ACTUATOR_PARAMETER(command, acceleration_limit_rad_s2, kAcceleration, 1.0, 1000.0, false),
    PMG_ACTUATOR_PARAMETER(command, hold_s, kPeriod, 0.0, 0.04, false),
    PMG_ACTUATOR_PARAMETER(drive, kp_scale, kNumber, 0.05, 20.0, false),
    PMG_ACTUATOR_PARAMETER(drive, kd_scale, kNumber, 0.02, 50.0, false),
    PMG_ACTUATOR_PARAMETER(drive, limit, kOutput, 0.05, 200.0, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_subtracts, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_wake_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(drive, output_dead_band, kOutput, 0.0, 20.0, false),
    PMG_ACTUATOR_PARAMETER(drive, output_rate_limit_per_s, kOutputRate, 0.5, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_delay_s, kDelay, 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_per_unit_Nm, kTorqueOfOutput, 0.01, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_scale, kNumber, 0.2, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, saturation_per_Nm, kShareOfTorque, 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(drive, back_emf_s_per_rad, kOutputOfSpeed, 0.01, 10.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_per_Nm, kShareOfTorque, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_time_s, kTime, 0.0, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_slow_share, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_limit_Nm, kTorque, 0.05, 400.0, false),
    PMG_ACTUATOR_PARAMETER(drive, brake_when_disabled, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, stall_torque_Nm, kTorque, 0.1, 400.0, false),
    PMG_ACTUATOR_PARAMETER(drive, no_load_rad_s, kSpeed, 1.0, 60.0, false),
    PMG_ACTUATOR_PARAMETER(drive, most_power_W, kPower, 0.2, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(drive, cut_speed_rad_s, kSpeed, 0.5, 60.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, zero_offset_rad, kAngle, -0.15, 0.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, hysteresis_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_order, kOrder, 1.0, 64.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_phase_rad, kPhase, -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, ellipticity_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, ellipticity_phase_rad, kPhase, -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, quantum_rad, kQuantum, 0.0, 0.02, false),
    PMG_ACTUATOR_PARAMETER(sensor, delay_s, kDelay, 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(sensor, lag_s, kTime, 0.0, 0.03, false),
    PMG_ACTUATOR_PARAMETER(sensor, lag_stages, kNumber, 1.0, 3.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, velocity_lag_s, kTime, 0.0, 0.03, false),
    PMG_ACTUATOR_PARAMETER(sensor, hold_s, kPeriod, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, on_motor, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, armature_kg_m2, kInertia, 1e-4, 0.5, false),
    PMG_ACTUATOR_PARAMETER(transmission, stiffness_Nm_per_rad, kStiffness, 5.0, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, hardening_Nm_per_rad3, kHardening, 10.0, 1e8, false),
    PMG_ACTUATOR_PARAMETER(transmission, damping_Nm_s_per_rad, kDamping, 0.0, 10.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, backlash_rad, kAngle, 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(transmission, friction_on_joint, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_Nm_s_per_rad, kDamping, 0.0, 5.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_quadratic_Nm_s2_per_rad2, kQuadraticDamping, 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_asymmetry, kNumber, -0.95, 0.95, true),
    PMG_ACTUATOR_PARAMETER(friction, coulomb_Nm, kTorque, 0.0, 10.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_Nm, kTorque, -5.0, 5.0, true),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_rad_s, kSpeed, 0.01, 5.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_exponent, kNumber, 0.3, 4.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_asymmetry, kNumber, -1.0, 1.0, true),
    PMG_ACTUATOR_PARAMETER(friction, load_driving, kNumber, 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(friction, load_backdriving, kNumber, 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(friction, load_by_motor, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, load_net, kNumber, 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, asymmetry, kNumber, -0.95, 0.95, true),
    PMG_ACTUATOR_PARAMETER(friction, presliding_rad, kAngle, 1e-4, 0.05, false),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_K, kShareOfTemperature, -0.1, 0.1, true),
    PMG_ACTUATOR_PARAMETER(thermal, viscous_per_K, kShareOfTemperature, -0.1, 0.1, true),
    PMG_ACTUATOR_PARAMETER(thermal, torque_per_K, kShareOfTemperature, -0.05, 0.05, true),
    PMG_ACTUATOR_PARAMETER(thermal, resistance_per_K, kShareOfTemperature, 0.0, 0.02, false),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_Nm2_s, kShareOfHeat, -0.2, 0.2, true),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_J, kShareOfWork, -5.0, 5.0, true),
    PMG_ACTUATOR_PARAMETER(thermal, torque_per_Nm2_s, kShareOfHeat, -0.5, 0.0, true),
    PMG_ACTUATOR_PARAMETER(thermal, cooling_s, kTime, 1.0, 1000.0, false),
    PMG_ACTUATOR_PARAMETER(thermal, torque_fade_share, kNumber, 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(thermal, torque_fade_s, kTime, 0.1, 100.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, amplitude_Nm, kTorque, 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, torque_share, kNumber, 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(ripple, order, kOrder, 1.0, 64.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, phase_rad, kPhase, -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(ripple, offset_Nm, kTorque, -5.0, 5.0, true),
};
#undef PMG_ACTUATOR_PARAMETER

}  // namespace

std::string_view unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::kNumber:
    case Quantity::kOrder:
      break;
    case Quantity::kTime:
    case Quantity::kDelay:
    case Quantity::kPeriod:
      return "s";
    case Quantity::kAngle:
    case Quantity::kQuantum:
    case Quantity::kPhase:
      return "rad";
    case Quantity::kSpeed:
      return "rad/s";
    case Quantity::kAcceleration:
      return "rad/s^2";
    case Quantity::kInertia:
      return "kg m^2";
    case Quantity::kTorque:
      return "Nm";
    case Quantity::kStiffness:
      return "Nm/rad";
    case Quantity::kHardening:
      return "Nm/rad^3";
    case Quantity::kDamping:
      return "Nm s/rad";
    case Quantity::kQuadraticDamping:
      return "Nm s^2/rad^2";
    case Quantity::kPower:
      return "W";
    case Quantity::kOutput:
      return "unit";
    case Quantity::kOutputRate:
      return "unit/s";
    case Quantity::kOutputOfSpeed:
      return "unit s/rad";
    case Quantity::kTorqueOfOutput:
      return "Nm/unit";
    case Quantity::kShareOfTorque:
      return "1/Nm";
    case Quantity::kShareOfTemperature:
      return "1/K";
    case Quantity::kShareOfHeat:
      return "1/(Nm^2 s)";
    case Quantity::kShareOfWork:
      return "1/J";
  }
  return "";
}

std::span<const ActuatorParameter> actuator_parameters() { return kParameters; }

const ActuatorParameter& actuator_parameter(std::string_view name) {
  std::vector<std::string> names;
  for (const ActuatorParameter& parameter : kParameters) {
    if (parameter.name == name) return parameter;
    names.emplace_back(parameter.name);
  }
  throw std::invalid_argument("no actuator parameter is called '" + std::string(name) + "'; " +
                              files::expected_name(name, names));
}

}  // namespace pmg::model
