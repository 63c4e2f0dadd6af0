#include "actuator/gear_friction.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

GearFriction::GearFriction(const model::ActuatorParameters::Friction& parameters, double step_s)
    : parameters_(parameters),
      step_s_(step_s),
      plain_viscous_(parameters.viscous_quadratic_Nm_s2_per_rad2 == 0.0 && parameters.viscous_asymmetry == 0.0) {}

void GearFriction::hold(double torque_Nm, double most_Nm) noexcept {
  if (most_Nm <= 0.0) return;
  const double direction = torque_Nm > 0.0 ? -1.0 : 1.0;
  bristle_rad_ = direction * parameters_.presliding_rad * std::min(1.0, std::abs(torque_Nm) / most_Nm);
}

}  // namespace pmg::actuator
