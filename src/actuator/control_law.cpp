#include "actuator/control_law.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

ControlLaw::ControlLaw(const model::ActuatorParameters& parameters, double step_s)
    : parameters_(parameters.drive), hold_(parameters.command.hold_s, step_s) {}

void ControlLaw::reset() noexcept {
  hold_.restart();
  held_ = of_position_ = 0.0;
  awake_ = true;
}

double ControlLaw::standing_output() const noexcept {
  return std::clamp(held_ - of_position_, -parameters_.limit, parameters_.limit);
}

/// Nothing below the dead band. A drive that fell asleep there wakes up beyond dead_band + wake. Above, the error loses
/// the share `subtracts` of the band.
double ControlLaw::beyond_dead_band_rad(double error_rad) noexcept {
  const double band_rad = parameters_.dead_band_rad;
  if (std::abs(error_rad) < band_rad)
    awake_ = false;
  else if (std::abs(error_rad) >= band_rad + parameters_.dead_band_wake_rad)
    awake_ = true;
  if (!awake_) return 0.0;
  return error_rad - parameters_.dead_band_subtracts * std::clamp(error_rad, -band_rad, band_rad);
}

}  // namespace pmg::actuator
