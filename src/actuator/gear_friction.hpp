// Friction on one side of a transmission.
#pragma once

#include <algorithm>
#include <cmath>

#include "actuator/torque_line.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

/// Dry friction is a bristle that bends by presliding_rad and then slides.
class GearFriction {
 public:
  GearFriction(const model::ActuatorParameters::Friction& parameters, double step_s);

  /// What temperature and heat make of it.
  struct Factors {
    double dry = 1.0, viscous = 1.0;
  };

  void reset() noexcept {
    bristle_rad_ = 0.0;
    more_ = {};
  }

  /// At rest, where the dry friction gives torque_Nm of at most most_Nm.
  void hold(double torque_Nm, double most_Nm) noexcept;

  /// Once a step, before torque(): the bristle takes part in the motion of the step before.
  void bend(double dq_rad_s) noexcept;

  /// What a residual torque adds to the largest dry friction, and its slope in |speed|.
  struct More {
    double most_Nm = 0.0, slope_Nm_s_per_rad = 0.0;
  };
  void add(const More& more) noexcept {
    more_ = more;
    has_more_ = true;
  }

  /// Whether dry friction holds: the bristle bends and does not slide.
  bool sticks() const noexcept { return std::abs(bristle_rad_) < parameters_.presliding_rad; }

  /// (speed, load on the gear, factors) => torque by speed.
  TorqueLine torque(double dq_rad_s, double load_Nm, const Factors& factors) const noexcept;

  /// Largest dry friction at the speed dq, for a motion in this direction (1 or -1):
  ///   (coulomb + stribeck exp(-|dq / stribeck_rad_s|^exponent) (1 + stribeck_asymmetry direction) +
  ///    load factor |load|) * factor * (1 + asymmetry direction) + what was added; not below 0 with that.
  double most_dry_Nm(double dq_rad_s, double direction, double load_Nm, double factor) const noexcept;

 private:
  TorqueLine dry(double dq_rad_s, double load_Nm, double factor) const noexcept;
  TorqueLine viscous(double dq_rad_s, double factor) const noexcept;

  model::ActuatorParameters::Friction parameters_;
  double step_s_;
  bool plain_viscous_;
  double bristle_rad_ = 0.0;
  More more_;
  bool has_more_ = false;
};

inline void GearFriction::bend(double dq_rad_s) noexcept {
  const double most_rad = parameters_.presliding_rad;
  bristle_rad_ = std::clamp(bristle_rad_ + step_s_ * dq_rad_s, -most_rad, most_rad);
}

/// -most_dry_friction * clamp(bend / presliding, -1, 1) with the bristle's bend at the end of the step.
inline TorqueLine GearFriction::dry(double dq_rad_s, double load_Nm, double factor) const noexcept {
  const double presliding_rad = parameters_.presliding_rad;
  const double bend_rad = bristle_rad_ + step_s_ * dq_rad_s;
  const double direction = bend_rad >= 0.0 ? 1.0 : -1.0;
  const double most_Nm = most_dry_Nm(dq_rad_s, direction, load_Nm, factor);
  if (std::abs(bend_rad) >= presliding_rad) return {-direction * most_Nm, -more_.slope_Nm_s_per_rad};
  const double stiffness = most_Nm / presliding_rad;
  return {-stiffness * bend_rad, -stiffness * step_s_};
}

/// -(viscous dq + viscous_quadratic |dq| dq) (1 + viscous_asymmetry sign(dq)).
inline TorqueLine GearFriction::viscous(double dq_rad_s, double factor) const noexcept {
  const model::ActuatorParameters::Friction& p = parameters_;
  const double linear = p.viscous_Nm_s_per_rad;
  if (plain_viscous_) return {-(factor * linear * dq_rad_s), -(factor * linear)};
  const double scale = -factor * (1.0 + p.viscous_asymmetry * (dq_rad_s >= 0.0 ? 1.0 : -1.0));
  const double square = p.viscous_quadratic_Nm_s2_per_rad2 * std::abs(dq_rad_s);
  return {scale * (linear + square) * dq_rad_s, scale * (linear + 2.0 * square)};
}

inline TorqueLine GearFriction::torque(double dq_rad_s, double load_Nm, const Factors& factors) const noexcept {
  const TorqueLine stuck = dry(dq_rad_s, load_Nm, factors.dry), flowing = viscous(dq_rad_s, factors.viscous);
  return {stuck.torque_Nm + flowing.torque_Nm, stuck.slope_Nm_s_per_rad + flowing.slope_Nm_s_per_rad};
}

inline double GearFriction::most_dry_Nm(double dq_rad_s, double direction, double load_Nm,
                                        double factor) const noexcept {
  const model::ActuatorParameters::Friction& p = parameters_;
  double most_Nm = p.coulomb_Nm;
  if (p.stribeck_Nm != 0.0) {
    const double ratio = dq_rad_s / p.stribeck_rad_s;
    const double power = p.stribeck_exponent == 2.0 ? ratio * ratio : std::pow(std::abs(ratio), p.stribeck_exponent);
    most_Nm += p.stribeck_Nm * std::exp(-power) * (1.0 + p.stribeck_asymmetry * direction);
  }
  if (load_Nm != 0.0) {
    most_Nm += (load_Nm * direction > 0.0 ? p.load_driving : p.load_backdriving) * std::abs(load_Nm);
  }
  most_Nm *= factor * (1.0 + p.asymmetry * direction);
  return has_more_ ? std::max(0.0, most_Nm + more_.most_Nm) : most_Nm;
}

}  // namespace pmg::actuator
