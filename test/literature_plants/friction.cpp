#include "friction.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

double dry_level_Nm(const Machine::Friction& f, const Scales& scales, double angle_rad, double speed_rad_s,
                    double direction) {
  double level_Nm = f.coulomb_Nm;
  if (f.stribeck_Nm != 0.0) {
    const double x = std::abs(speed_rad_s) / f.stribeck_rad_s;
    const double curve = f.stribeck_lorentz ? 1.0 / (1.0 + x * x) : std::exp(-std::pow(x, f.stribeck_exponent));
    level_Nm += f.stribeck_Nm * curve * (1.0 + f.stribeck_asymmetry * direction);
  }
  level_Nm += f.rub_Nm_per_rad * std::max(0.0, angle_rad - f.rub_from_rad);
  return scales.friction * level_Nm * (1.0 + f.asymmetry * direction);
}

double viscous_Nm(const Machine::Friction& f, const Scales& scales, double speed_rad_s) {
  const double direction = speed_rad_s > 0.0 ? 1.0 : -1.0;
  double torque_Nm = f.viscous_Nm_s_per_rad * speed_rad_s * (1.0 + f.viscous_asymmetry * direction);
  if (f.power_Nm != 0.0) torque_Nm += direction * f.power_Nm * std::pow(std::abs(speed_rad_s), f.power_exponent);
  return scales.viscous * torque_Nm;
}

LoadShare load_share(const Machine::Friction& f, double motor_Nm, double outside_Nm, bool driving) {
  switch (f.load_form) {
    case LoadForm::kNone:
      return {};
    case LoadForm::kNet:
      return {0.0, f.load_driving * 0.5 * std::abs(motor_Nm - outside_Nm)};
    case LoadForm::kMotor:
      return {0.0, f.load_driving * std::abs(motor_Nm)};
    case LoadForm::kTransmitted:
      return {f.load_driving, 0.0};
    case LoadForm::kPowerFlow:
      return {driving ? f.load_driving : f.load_backdriving, 0.0};
  }
  return {};
}

bool has_dry_friction(const Machine& machine) {
  const Machine::Friction& f = machine.friction;
  return f.coulomb_Nm > 0.0 || f.stribeck_Nm > 0.0 || f.rub_Nm_per_rad > 0.0 || f.dwell_Nm > 0.0 ||
         f.load_form != LoadForm::kNone;
}

}  // namespace pmg::literature
