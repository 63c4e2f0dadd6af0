#include "model/actuator_parameters.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/nearest_name.hpp"

namespace pmg::model {

namespace {

#define PMG_ACTUATOR_PARAMETER(group, key, unit, lower, upper, negative)                                         \
  ActuatorParameter {                                                                                            \
#group "." #key, unit, lower, upper, negative, [](ActuatorParameters & p) -> double& { return p.group.key; } \
  }

// The ranges cover joints from a hobby servo's to a humanoid's knee; a linear rig scales them.
constexpr std::array kParameters = {
    PMG_ACTUATOR_PARAMETER(command, delay_s, "s", 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(command, update_s, "s", 0.0, 0.2, false),
    PMG_ACTUATOR_PARAMETER(command, rate_limit_rad_s, "rad/s", 1.0, 30.0, false),
    PMG_ACTUATOR_PARAMETER(command, acceleration_limit_rad_s2, "rad/s^2", 1.0, 1000.0, false),
    PMG_ACTUATOR_PARAMETER(command, hold_s, "s", 0.0, 0.04, false),
    PMG_ACTUATOR_PARAMETER(drive, kp_scale, "", 0.05, 20.0, false),
    PMG_ACTUATOR_PARAMETER(drive, kd_scale, "", 0.02, 50.0, false),
    PMG_ACTUATOR_PARAMETER(drive, limit, "unit", 0.05, 200.0, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_subtracts, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, dead_band_wake_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(drive, output_dead_band, "unit", 0.0, 20.0, false),
    PMG_ACTUATOR_PARAMETER(drive, output_rate_limit_per_s, "unit/s", 0.5, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_delay_s, "s", 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_per_unit_Nm, "Nm/unit", 0.01, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, torque_scale, "", 0.2, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, saturation_per_Nm, "1/Nm", 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(drive, back_emf_s_per_rad, "unit s/rad", 0.01, 10.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_per_Nm, "1/Nm", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_time_s, "s", 0.0, 5.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_sag_slow_share, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, supply_limit_Nm, "Nm", 0.05, 400.0, false),
    PMG_ACTUATOR_PARAMETER(drive, brake_when_disabled, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(drive, stall_torque_Nm, "Nm", 0.1, 400.0, false),
    PMG_ACTUATOR_PARAMETER(drive, no_load_rad_s, "rad/s", 1.0, 60.0, false),
    PMG_ACTUATOR_PARAMETER(drive, most_power_W, "W", 0.2, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(drive, cut_speed_rad_s, "rad/s", 0.5, 60.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, zero_offset_rad, "rad", -0.15, 0.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, hysteresis_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_order, "", 1.0, 64.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, eccentricity_phase_rad, "rad", -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, ellipticity_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, ellipticity_phase_rad, "rad", -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(sensor, quantum_rad, "rad", 0.0, 0.02, false),
    PMG_ACTUATOR_PARAMETER(sensor, delay_s, "s", 0.0, 0.06, false),
    PMG_ACTUATOR_PARAMETER(sensor, lag_s, "s", 0.0, 0.03, false),
    PMG_ACTUATOR_PARAMETER(sensor, lag_stages, "", 1.0, 3.0, false),
    PMG_ACTUATOR_PARAMETER(sensor, velocity_lag_s, "s", 0.0, 0.03, false),
    PMG_ACTUATOR_PARAMETER(sensor, hold_s, "s", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(sensor, on_motor, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, armature_kg_m2, "kg m^2", 1e-4, 0.5, false),
    PMG_ACTUATOR_PARAMETER(transmission, stiffness_Nm_per_rad, "Nm/rad", 5.0, 5000.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, hardening_Nm_per_rad3, "Nm/rad^3", 10.0, 1e8, false),
    PMG_ACTUATOR_PARAMETER(transmission, damping_Nm_s_per_rad, "Nm s/rad", 0.0, 10.0, false),
    PMG_ACTUATOR_PARAMETER(transmission, backlash_rad, "rad", 0.0, 0.1, false),
    PMG_ACTUATOR_PARAMETER(transmission, friction_on_joint, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_Nm_s_per_rad, "Nm s/rad", 0.0, 5.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_quadratic_Nm_s2_per_rad2, "Nm s^2/rad^2", 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(friction, viscous_asymmetry, "", -0.95, 0.95, true),
    PMG_ACTUATOR_PARAMETER(friction, coulomb_Nm, "Nm", 0.0, 10.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_Nm, "Nm", -5.0, 5.0, true),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_rad_s, "rad/s", 0.01, 5.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_exponent, "", 0.3, 4.0, false),
    PMG_ACTUATOR_PARAMETER(friction, stribeck_asymmetry, "", -1.0, 1.0, true),
    PMG_ACTUATOR_PARAMETER(friction, load_driving, "", 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(friction, load_backdriving, "", 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(friction, load_by_motor, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, load_net, "", 0.0, 1.0, false),
    PMG_ACTUATOR_PARAMETER(friction, asymmetry, "", -0.95, 0.95, true),
    PMG_ACTUATOR_PARAMETER(friction, presliding_rad, "rad", 1e-4, 0.05, false),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_K, "1/K", -0.1, 0.1, true),
    PMG_ACTUATOR_PARAMETER(thermal, viscous_per_K, "1/K", -0.1, 0.1, true),
    PMG_ACTUATOR_PARAMETER(thermal, torque_per_K, "1/K", -0.05, 0.05, true),
    PMG_ACTUATOR_PARAMETER(thermal, resistance_per_K, "1/K", 0.0, 0.02, false),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_Nm2_s, "1/(Nm^2 s)", -0.2, 0.2, true),
    PMG_ACTUATOR_PARAMETER(thermal, friction_per_J, "1/J", -5.0, 5.0, true),
    PMG_ACTUATOR_PARAMETER(thermal, torque_per_Nm2_s, "1/(Nm^2 s)", -0.5, 0.0, true),
    PMG_ACTUATOR_PARAMETER(thermal, cooling_s, "s", 1.0, 1000.0, false),
    PMG_ACTUATOR_PARAMETER(thermal, torque_fade_share, "", 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(thermal, torque_fade_s, "s", 0.1, 100.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, amplitude_Nm, "Nm", 0.0, 2.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, torque_share, "", 0.0, 0.9, false),
    PMG_ACTUATOR_PARAMETER(ripple, order, "", 1.0, 64.0, false),
    PMG_ACTUATOR_PARAMETER(ripple, phase_rad, "rad", -3.15, 3.15, true),
    PMG_ACTUATOR_PARAMETER(ripple, offset_Nm, "Nm", -5.0, 5.0, true),
};
#undef PMG_ACTUATOR_PARAMETER

}  // namespace

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
