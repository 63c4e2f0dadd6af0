// An effect's strength as a model-free check measures it.
#pragma once

#include <vector>

#include "bench/bench.hpp"
#include "evidence/signature.hpp"

namespace pmg::evidence {

/// (check, joint without the effect, fastest speed [rad/s]) => (values of the effect's parameters in the catalogue's
/// order; empty for checks whose value is no parameter). A value in volts counts torque_per_unit_Nm each.
std::vector<double> measured_strength(const Signature& check, const model::ActuatorParameters& joint,
                                      double fastest_rad_s, const SignatureOptions& options);

/// False where the check measures the other sign than the effect's physics has. Friction that is smaller at low speed
/// than at high speed is viscous friction that levels off, and not Stribeck friction.
bool has_its_sign(const Signature& check);

}  // namespace pmg::evidence
