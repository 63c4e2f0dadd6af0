#include "actuator/shaft.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

Shaft::Shaft(const model::ActuatorParameters::Transmission& parameters, double step_s)
    : parameters_(parameters), step_s_(step_s) {}

void Shaft::reset(double q_rad, double load_Nm, double slack_rad) noexcept {
  rotor_rad_ = load_Nm == 0.0 ? q_rad + slack_rad : q_rad + twist_rad(parameters_, load_Nm);
  rotor_rad_s_ = wound_rad_ = bend_rad_ = 0.0;
  if (parameters_.hysteretic_share == 0.0) return;
  const double wound = wound_rad(rotor_rad_ - q_rad);
  bend_rad_ = wound == 0.0 ? 0.0 : bend_rad(wound);
  wound_rad_ = wound;
}

/// Solves stiffness ((1 - share) x + share z(x)) + hardening x^3 = |load|, with z = hysteresis (1 - exp(-x /
/// hysteresis)): by Newton's method from above, where it converges evenly, and for a belt by halving.
double Shaft::twist_rad(const model::ActuatorParameters::Transmission& p, double load_Nm) {
  if (std::isinf(p.stiffness_Nm_per_rad) || load_Nm == 0.0) return 0.0;
  double wound_rad = std::abs(load_Nm) / p.stiffness_Nm_per_rad;
  if (p.hysteretic_share > 0.0) {
    double low_rad = 0.0, high_rad = wound_rad / (1.0 - p.hysteretic_share);
    for (int i = 0; i < 60; ++i) {
      wound_rad = 0.5 * (low_rad + high_rad);
      const double bend_rad = -p.hysteresis_rad * std::expm1(-wound_rad / p.hysteresis_rad);
      const double torque_Nm = p.stiffness_Nm_per_rad * (wound_rad + p.hysteretic_share * (bend_rad - wound_rad)) +
                               p.hardening_Nm_per_rad3 * wound_rad * wound_rad * wound_rad;
      (torque_Nm < std::abs(load_Nm) ? low_rad : high_rad) = wound_rad;
    }
    return std::copysign(wound_rad + 0.5 * p.backlash_rad, load_Nm);
  }
  for (int i = 0; i < 40 && p.hardening_Nm_per_rad3 > 0.0; ++i) {
    const double square = p.hardening_Nm_per_rad3 * wound_rad * wound_rad;
    wound_rad -=
        ((p.stiffness_Nm_per_rad + square) * wound_rad - std::abs(load_Nm)) / (p.stiffness_Nm_per_rad + 3.0 * square);
  }
  return std::copysign(wound_rad + 0.5 * p.backlash_rad, load_Nm);
}

}  // namespace pmg::actuator
