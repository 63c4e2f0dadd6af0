// A rotor behind a shaft that winds, with free play.
#pragma once

#include <algorithm>
#include <cmath>

#include "actuator/torque_line.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

class Shaft {
 public:
  Shaft(const model::ActuatorParameters::Transmission& parameters, double step_s);

  /// At rest there, wound by this torque from an unwound shaft. Without a torque the rotor is ahead by slack_rad,
  /// within the play.
  void reset(double q_rad, double load_Nm = 0.0, double slack_rad = 0.0) noexcept;

  /// (the motor's torque, the joint's angle and speed) => torque on the joint by its speed. Moves the rotor.
  TorqueLine step(TorqueLine motor, double q_rad, double dq_rad_s) noexcept;

  double rotor_rad() const noexcept { return rotor_rad_; }
  double rotor_rad_s() const noexcept { return rotor_rad_s_; }

  /// By how much the rotor is ahead of a joint at rest that carries this torque; 0 for a rigid transmission.
  static double twist_rad(const model::ActuatorParameters::Transmission& parameters, double load_Nm);

 private:
  TorqueLine torque(double rotor_rad_s, double q_rad, double dq_rad_s) const noexcept;
  double wound_rad(double twist_rad) const noexcept;
  double bend_rad(double wound_rad) const noexcept;

  model::ActuatorParameters::Transmission parameters_;
  double step_s_;
  double rotor_rad_ = 0.0, rotor_rad_s_ = 0.0;
  double wound_rad_ = 0.0, bend_rad_ = 0.0;  ///< at the beginning of the step, of a belt
};

/// The twist beyond the play.
inline double Shaft::wound_rad(double twist_rad) const noexcept {
  const double half_play_rad = 0.5 * parameters_.backlash_rad;
  return twist_rad - std::clamp(twist_rad, -half_play_rad, half_play_rad);
}

/// The bend of a belt that has wound evenly from where it was to here.
inline double Shaft::bend_rad(double wound_rad) const noexcept {
  const double most_rad = std::copysign(parameters_.hysteresis_rad, wound_rad - wound_rad_);
  return most_rad + (bend_rad_ - most_rad) * std::exp(-std::abs(wound_rad - wound_rad_) / parameters_.hysteresis_rad);
}

/// On the joint, with the shaft's twist x beyond its play and a belt's bend z at the end of the step:
///   stiffness ((1 - share) x + share z) + hardening x^3 + damping relative speed; nothing within the play.
/// The slope is in the relative speed.
inline TorqueLine Shaft::torque(double rotor_rad_s, double q_rad, double dq_rad_s) const noexcept {
  const model::ActuatorParameters::Transmission& p = parameters_;
  const double relative_rad_s = rotor_rad_s - dq_rad_s;
  const double wound = wound_rad(rotor_rad_ - q_rad + step_s_ * relative_rad_s);
  if (wound == 0.0 && (bend_rad_ == 0.0 || p.backlash_rad > 0.0)) return {};
  const double square = p.hardening_Nm_per_rad3 * wound * wound;
  TorqueLine line{(p.stiffness_Nm_per_rad + square) * wound + p.damping_Nm_s_per_rad * relative_rad_s,
                  (p.stiffness_Nm_per_rad + 3.0 * square) * step_s_ + p.damping_Nm_s_per_rad};
  if (p.hysteretic_share > 0.0) {
    const double bend = bend_rad(wound), share_Nm_per_rad = p.hysteretic_share * p.stiffness_Nm_per_rad;
    const double levelled = bend / std::copysign(p.hysteresis_rad, wound - wound_rad_);
    line.torque_Nm += share_Nm_per_rad * (bend - wound);
    line.slope_Nm_s_per_rad -= share_Nm_per_rad * levelled * step_s_;
  }
  return line;
}

/// First the rotor moves, against a shaft whose joint end keeps its speed:
///   w' = w + (motor - shaft) / (J / h - motor slope + shaft slope).
/// Then the shaft's torque at w' acts on the joint. Both are implicit in their own speed, so a stiff shaft stays
/// stable.
inline TorqueLine Shaft::step(TorqueLine motor, double q_rad, double dq_rad_s) noexcept {
  if (parameters_.hysteretic_share > 0.0) {
    const double now_rad = wound_rad(rotor_rad_ - q_rad);
    bend_rad_ = bend_rad(now_rad);
    wound_rad_ = now_rad;
  }
  const TorqueLine before = torque(rotor_rad_s_, q_rad, dq_rad_s);
  rotor_rad_s_ += (motor.torque_Nm - before.torque_Nm) /
                  (parameters_.armature_kg_m2 / step_s_ - motor.slope_Nm_s_per_rad + before.slope_Nm_s_per_rad);
  const TorqueLine after = torque(rotor_rad_s_, q_rad, dq_rad_s);
  rotor_rad_ += step_s_ * rotor_rad_s_;
  return {after.torque_Nm, -after.slope_Nm_s_per_rad};
}

}  // namespace pmg::actuator
