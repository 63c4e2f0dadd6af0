#include "actuator/shaft.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

Shaft::Shaft(const model::ActuatorParameters::Transmission& parameters, double step_s)
    : parameters_(parameters), step_s_(step_s) {}

void Shaft::reset(double q_rad, double load_Nm, double slack_rad) noexcept {
  rotor_rad_ = load_Nm == 0.0 ? q_rad + slack_rad : q_rad + twist_rad(parameters_, load_Nm);
  rotor_rad_s_ = 0.0;
}

/// Solves stiffness x + hardening x^3 = |load| by Newton's method from above, where it converges evenly.
double Shaft::twist_rad(const model::ActuatorParameters::Transmission& p, double load_Nm) {
  if (std::isinf(p.stiffness_Nm_per_rad) || load_Nm == 0.0) return 0.0;
  double wound_rad = std::abs(load_Nm) / p.stiffness_Nm_per_rad;
  for (int i = 0; i < 40 && p.hardening_Nm_per_rad3 > 0.0; ++i) {
    const double square = p.hardening_Nm_per_rad3 * wound_rad * wound_rad;
    wound_rad -=
        ((p.stiffness_Nm_per_rad + square) * wound_rad - std::abs(load_Nm)) / (p.stiffness_Nm_per_rad + 3.0 * square);
  }
  return std::copysign(wound_rad + 0.5 * p.backlash_rad, load_Nm);
}

}  // namespace pmg::actuator
