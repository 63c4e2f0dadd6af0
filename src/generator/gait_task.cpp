#include "generator/gait_task.hpp"

#include <cmath>
#include <numbers>

namespace pmg::generator {

double stance_phase(double phase, Foot foot, double duty_factor) {
  const double center = 0.5 * duty_factor + (foot == kRight ? 0.5 : 0.0);
  const double s = phase - center;
  return s - std::floor(s + 0.5);
}

Roll hike(const GaitTask& task, double phase) {
  // The left side is highest early in its swing, where a foot that has just lifted off needs the room.
  const double left_peak = task.duty_factor + 0.03;
  const double angle = 2.0 * std::numbers::pi * (phase - left_peak);
  return {task.hike_rad * std::cos(angle), -2.0 * std::numbers::pi * task.hike_rad * std::sin(angle)};
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
