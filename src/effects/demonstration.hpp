// How an effect is shown: a joint with it moves otherwise than the same joint without it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace pmg::effects {

/// A parameter of model::actuator_parameters, or load.inertia_scale, load.gravity_scale, and its value.
struct FixedValue {
  std::string parameter;
  double value = 0.0;
};

// Commanded positions [rad] over 3.4 s.
inline double steps(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.4 ? 0.8 : t_s < 2.4 ? 0.3 : -0.4; }
inline double big_step(double t_s) { return t_s < 0.2 ? 0.0 : t_s < 1.6 ? 1.5 : 0.0; }
inline double sine(double t_s) { return 0.6 * std::sin(2.0 * std::numbers::pi * 0.6 * t_s); }
inline double slow_sine(double t_s) { return 0.25 * std::sin(2.0 * std::numbers::pi * 0.3 * t_s); }
inline double triangle(double t_s) { return 0.3 * std::asin(std::sin(2.0 * std::numbers::pi * 0.4 * t_s)); }
inline double slow_ramp(double t_s) { return std::min(0.6 * t_s, 1.8); }

/// What docs/images/effects draws of an effect.
struct Demonstration {
  double (*command_rad)(double t_s) = steps;
  std::vector<FixedValue> with;                                                 ///< what the effect changes
  std::vector<FixedValue> both = {};                                            ///< what both joints have
  enum class Against { kTime, kPosition, kVelocity } against = Against::kTime;  ///< of the residual's picture
  double kp_Nm_per_rad = 25.0, gravity_Nm = 1.5;
};

}  // namespace pmg::effects
