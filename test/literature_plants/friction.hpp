// Friction's torque as a function of state: levels of dry friction, viscous friction.
#pragma once

#include "machine.hpp"

namespace pmg::literature {

/// What temperature, heat and time make of friction and torque.
struct Scales {
  double friction = 1.0, viscous = 1.0, torque = 1.0, back_emf = 1.0;
};

/// (angle, speed, direction 1 or -1) => largest dry friction that doesn't depend on the load [Nm]:
///   (coulomb + stribeck curve(|v/vs|) (1 + stribeck_asymmetry direction) + rub) (1 + asymmetry direction) scale.
/// curve is exp(-x^exponent): exponent 1 in Tustin (1947), 0.5 to 1 in Bo and Pavelescu (1982), 2 in Armstrong-Helouvry
/// (1991); or 1 / (1 + x^2), Hess and Soom (1990).
double dry_level_Nm(const Machine::Friction& friction, const Scales& scales, double angle_rad, double speed_rad_s,
                    double direction);

/// (speed) => torque against the motion [Nm], of the speed's sign: b v (1 + viscous_asymmetry sign(v)) and
/// power |v|^exponent, which is 2 for churning oil (Changenet, Oviedo-Marlot, Velex 2006) and below 1 for grease
/// (Waiboer, Aarts, Jonker 2005).
double viscous_Nm(const Machine::Friction& friction, const Scales& scales, double speed_rad_s);

/// (motor torque, external torque, torque through the gear, direction of motion) => share of |torque through the gear|,
/// and what comes besides [Nm].
struct LoadShare {
  double of_transmitted = 0.0, besides_Nm = 0.0;
};
LoadShare load_share(const Machine::Friction& friction, double motor_Nm, double outside_Nm, bool driving);

bool has_dry_friction(const Machine& machine);

}  // namespace pmg::literature
