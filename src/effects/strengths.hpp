// What of an effect's parameters is its strength, and whether two effects are one torque.
#pragma once

#include <string>
#include <vector>

#include "effects/extension.hpp"
#include "evidence/signature.hpp"

namespace pmg::effects {

/// The parameters of an effect's form that are neutral without it. Not its shape: a speed, an order, a phase, a
/// damping.
std::vector<std::string> strengths(const Effect& effect, const Form& form);
std::vector<std::string> strengths(const std::string& effect, const Forms& forms);

/// (check, joint without the effect, fastest speed [rad/s]) => (values of the effect's parameters in the catalogue's
/// order; empty for checks whose value is no parameter). A value in volts counts torque_per_unit_Nm each.
std::vector<double> measured_strength(const evidence::Signature& check, const model::ActuatorParameters& joint,
                                      double fastest_rad_s, const evidence::SignatureOptions& options);

/// False where the check measures the other sign than the effect's physics has. Friction that is smaller at low speed
/// than at high speed is viscous friction that levels off, and not Stribeck friction.
bool has_its_sign(const evidence::Signature& check);

/// True if the effect's strength has the other sign than its physics: a Stribeck term below zero is viscous friction
/// that levels off.
bool has_other_sign(const std::string& effect, const calib::JointModel& model);

/// True if the effect's form has Stribeck friction of which less than half fades up to this speed [rad/s]: on such runs
/// it is Coulomb friction by another name, and may take the place of Coulomb friction and of a second effect.
bool fades_unseen(const std::string& effect, const Forms& forms, const calib::JointModel& model, double speed_rad_s);

/// True where a number of an effect is at the edge of its range at which the effect is none, or another: the stiffest
/// shaft is rigid; torque that has faded at once is weaker from the beginning, a gain.
bool at_its_limit(const NestedModel& model);

/// (linearised model, its forms, the model without effects, two of its effects) => (cosine of what the two do to the
/// rollouts). With the difference d of an effect's strengths from neutral and the Jacobian's columns J of these
/// strengths, beyond what all other unknowns can do, the effect does J d. 1: both do the same; -1: they cancel. 0 where
/// one does nothing.
double likeness(const NestedModel& model, const Forms& forms, const calib::JointModel& neutral,
                const std::string& first, const std::string& second);

}  // namespace pmg::effects
