#include "actuator/checks.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "actuator/delay_line.hpp"

namespace pmg::actuator {

namespace {

/// Makes its text only where it throws: each rollout of a fit checks its parameters.
void expect(bool holds, const char* what, const char* is = "") {
  if (!holds) throw std::invalid_argument(std::string(what) + is);
}

void expect_short(const char* name, double delay_s, double step_s) {
  constexpr int kMost = DelayLine<double>::kSteps;
  if (delay_s >= 0.0 && delay_s <= kMost * step_s) return;
  throw std::invalid_argument(std::string(name) + ": a delay of " + std::to_string(delay_s) + " s; expected at most " +
                              std::to_string(kMost) + " steps");
}

void expect_above_0(const char* name, double value) { expect(value > 0.0, name, " isn't above 0"); }

void expect_at_least_0(const char* name, double value) { expect(value >= 0.0, name, " is below 0"); }

void expect_share(const char* name, double value) { expect(value >= 0.0 && value <= 1.0, name, " isn't from 0 to 1"); }

void expect_within_1(const char* name, double value) {
  expect(std::abs(value) <= 1.0, name, " isn't from -1 to 1: friction would push");
}

void check_drive(const model::ActuatorParameters::Drive& p) {
  expect_above_0("drive.no_load_rad_s", p.no_load_rad_s);
  expect_above_0("drive.output_rate_limit_per_s", p.output_rate_limit_per_s);
  expect_above_0("drive.torque_scale", p.torque_scale);
  expect_above_0("drive.most_power_W", p.most_power_W);
  expect_above_0("drive.cut_speed_rad_s", p.cut_speed_rad_s);
  expect_above_0("drive.supply_limit_Nm", p.supply_limit_Nm);
  expect_at_least_0("drive.output_dead_band", p.output_dead_band);
  expect_at_least_0("drive.dead_band_wake_rad", p.dead_band_wake_rad);
  expect_at_least_0("drive.saturation_per_Nm", p.saturation_per_Nm);
  expect_at_least_0("drive.supply_sag_time_s", p.supply_sag_time_s);
  expect_share("drive.dead_band_subtracts", p.dead_band_subtracts);
  expect_share("drive.supply_sag_slow_share", p.supply_sag_slow_share);
}

void check_friction(const model::ActuatorParameters::Friction& p) {
  expect_above_0("friction.presliding_rad", p.presliding_rad);
  expect_above_0("friction.stribeck_rad_s", p.stribeck_rad_s);
  expect_above_0("friction.stribeck_exponent", p.stribeck_exponent);
  expect_at_least_0("friction.viscous_quadratic_Nm_s2_per_rad2", p.viscous_quadratic_Nm_s2_per_rad2);
  expect_within_1("friction.viscous_asymmetry", p.viscous_asymmetry);
  expect_within_1("friction.stribeck_asymmetry", p.stribeck_asymmetry);
  expect_share("friction.load_by_motor", p.load_by_motor);
  expect_share("friction.load_net", p.load_net);
  expect(p.load_by_motor + p.load_net <= 1.0, "friction.load_by_motor and friction.load_net are above 1 together");
}

}  // namespace

void expect_simulable(const model::ActuatorParameters& parameters, double step_s) {
  expect(step_s > 0.0, "an actuator's step isn't above 0");
  const auto& [command, drive, sensor, transmission, friction, thermal, ripple, residual] = parameters;
  expect_short("command.delay_s", command.delay_s, step_s);
  expect_short("drive.torque_delay_s", drive.torque_delay_s, step_s);
  expect_short("sensor.delay_s", sensor.delay_s, step_s);
  expect_above_0("command.rate_limit_rad_s", command.rate_limit_rad_s);
  expect_above_0("command.acceleration_limit_rad_s2", command.acceleration_limit_rad_s2);
  expect_at_least_0("command.update_s", command.update_s);
  check_drive(drive);
  expect(std::abs(sensor.eccentricity_order * sensor.eccentricity_rad) + 2.0 * std::abs(sensor.ellipticity_rad) < 1.0,
         "eccentricity times its order and twice the ellipticity are a radian or more; expected a reading that grows "
         "with q");
  expect_at_least_0("sensor.hold_s", sensor.hold_s);
  expect(sensor.lag_stages == 1.0 || sensor.lag_stages == 2.0 || sensor.lag_stages == 3.0,
         "sensor.lag_stages isn't 1, 2 or 3");
  expect_share("sensor.on_motor", sensor.on_motor);
  check_friction(friction);
  expect_above_0("thermal.cooling_s", thermal.cooling_s);
  expect_above_0("thermal.torque_fade_s", thermal.torque_fade_s);
  expect_share("thermal.torque_fade_share", thermal.torque_fade_share);
  const bool elastic = std::isfinite(transmission.stiffness_Nm_per_rad);
  expect(!elastic || transmission.armature_kg_m2 > 0.0, "a rotor behind a spring needs an armature");
  expect(elastic || (transmission.backlash_rad == 0.0 && transmission.damping_Nm_s_per_rad == 0.0 &&
                     transmission.hardening_Nm_per_rad3 == 0.0),
         "backlash, shaft damping and hardening need a transmission.stiffness_Nm_per_rad");
  expect_at_least_0("transmission.hardening_Nm_per_rad3", transmission.hardening_Nm_per_rad3);
  expect_share("transmission.friction_on_joint", transmission.friction_on_joint);
  model::check(residual);
}

}  // namespace pmg::actuator
