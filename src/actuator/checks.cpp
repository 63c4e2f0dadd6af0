#include "actuator/checks.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "actuator/delay_line.hpp"

namespace pmg::actuator {

namespace {

void expect(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

/// Why it isn't allowed; nothing if it is.
const char* refusal(model::Allowed allowed, double value) {
  switch (allowed) {
    case model::Allowed::kAny:
      return nullptr;
    case model::Allowed::kNotNegative:
      return value >= 0.0 ? nullptr : " is below 0";
    case model::Allowed::kPositive:
      return value > 0.0 ? nullptr : " isn't above 0";
    case model::Allowed::kShare:
      return value >= 0.0 && value <= 1.0 ? nullptr : " isn't from 0 to 1";
    case model::Allowed::kWithinOne:
      return std::abs(value) <= 1.0 ? nullptr : " isn't from -1 to 1: friction would push";
  }
  return nullptr;
}

}  // namespace

void expect_simulable(const model::ActuatorParameters& parameters, double step_s) {
  expect(step_s > 0.0, "an actuator's step isn't above 0");
  for (const model::ActuatorParameter& p : model::actuator_parameters()) {
    const double value = p.value(parameters);
    if (const char* why = refusal(p.allowed, value)) throw std::invalid_argument(std::string(p.name) + why);
    constexpr int kMost = DelayLine<double>::kSteps;
    if (p.quantity == model::Quantity::kDelay && value > kMost * step_s)
      throw std::invalid_argument(std::string(p.name) + ": a delay of " + std::to_string(value) +
                                  " s; expected at most " + std::to_string(kMost) + " steps");
  }
  const auto& [command, drive, sensor, transmission, friction, thermal, ripple, residual] = parameters;
  expect(std::abs(sensor.eccentricity_order * sensor.eccentricity_rad) + 2.0 * std::abs(sensor.ellipticity_rad) <
             sensor.angle_scale,
         "eccentricity times its order and twice the ellipticity are the reading's scale or more; expected a reading "
         "that grows "
         "with q");
  expect(sensor.lag_stages == 1.0 || sensor.lag_stages == 2.0 || sensor.lag_stages == 3.0,
         "sensor.lag_stages isn't 1, 2 or 3");
  expect(friction.load_by_motor + friction.load_net <= 1.0,
         "friction.load_by_motor and friction.load_net are above 1 together");
  const bool elastic = std::isfinite(transmission.stiffness_Nm_per_rad);
  expect(!elastic || transmission.armature_kg_m2 > 0.0, "a rotor behind a spring needs an armature");
  expect(elastic || (transmission.backlash_rad == 0.0 && transmission.damping_Nm_s_per_rad == 0.0 &&
                     transmission.hardening_Nm_per_rad3 == 0.0 && transmission.hysteretic_share == 0.0),
         "backlash, shaft damping, hardening and hysteresis need a transmission.stiffness_Nm_per_rad");
  expect(transmission.hysteretic_share < 1.0, "transmission.hysteretic_share is 1: nothing would carry a load");
  model::check(residual);
}

}  // namespace pmg::actuator
