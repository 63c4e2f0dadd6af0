#include "evidence/strength.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pmg::evidence {

std::vector<double> measured_strength(const Signature& check, const model::ActuatorParameters& joint,
                                      double fastest_rad_s, const SignatureOptions& options) {
  const std::string& effect = check.effect;
  const double value = check.value.value;
  if (!std::isfinite(value)) return {};
  // Of a voltage servo the balance is in volts.
  const double torque = joint.drive.back_emf_s_per_rad > 0.0 ? value * joint.drive.torque_per_unit_Nm : value;
  if (effect == "coulomb" || effect == "viscous") return {std::max(0.0, torque)};
  if (effect == "stribeck") return {torque, options.slow_share * fastest_rad_s};
  if (effect == "load_friction") return {torque, torque};
  // The balance is drive = load + friction - constant torque, and friction is coulomb (1 + asymmetry direction).
  if (effect == "offset") return {-torque};
  if (effect == "direction_friction" && joint.friction.coulomb_Nm > 0.0) return {torque / joint.friction.coulomb_Nm};
  // A reading r = q + z: gravity G sin(r - z) is G sin r - z G cos r.
  if (effect == "zero_offset") return {-torque};
  if (effect == "gain" || effect == "dead_band" || effect == "delay" || effect == "rate_limit") return {value};
  return {};
}

bool has_its_sign(const Signature& check) {
  constexpr std::array kNeverNegative = {"coulomb", "viscous", "stribeck", "load_friction", "dead_band", "delay"};
  const bool never = std::find(kNeverNegative.begin(), kNeverNegative.end(), check.effect) != kNeverNegative.end();
  return !never || !(check.value.value < 0.0);
}

}  // namespace pmg::evidence
