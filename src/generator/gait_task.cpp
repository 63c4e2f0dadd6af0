#include "generator/gait_task.hpp"

#include <cmath>
#include <numbers>

namespace pmg::generator {

double stance_phase(double phase, Foot foot, double duty_factor) {
  const double center = 0.5 * duty_factor + (foot == kRight ? 0.5 : 0.0);
  const double s = phase - center;
  return s - std::floor(s + 0.5);
}

double contact_weight(double stance_phase, double duty_factor, double edge_cycle) {
  const double inside = 0.5 * duty_factor - std::abs(stance_phase);
  if (inside >= 0.5 * edge_cycle) {
    return 1.0;
  }
  if (inside <= -0.5 * edge_cycle) {
    return 0.0;
  }
  return 0.5 + 0.5 * std::sin(std::numbers::pi * inside / edge_cycle);
}

}  // namespace pmg::generator
