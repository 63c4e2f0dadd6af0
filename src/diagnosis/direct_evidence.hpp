// What checks without a model say for and against causes.
#pragma once

#include <string>
#include <vector>

#include "evidence/signature.hpp"
#include "sim/actuator_parameters.hpp"

namespace pmg::diagnosis {

/// An effect whose parameter is read off the recordings. No fit has a say in it: what it does to a rollout may be a
/// limit cycle, of which no model knows the phase.
struct MeasuredCause {
  std::string effect, parameter;
  evidence::Interval value;  ///< of the parameter, in its own unit
};

struct DirectEvidence {
  /// Quantisation, where the readings' step is coarser than the base's and makes up a good part of the noise. A fine
  /// sensor's readings, too, are multiples of one number.
  std::vector<MeasuredCause> measured;
  /// Effects of which the base has nothing and which the recordings show, and no other effect would look so: thermal
  /// drift, where runs that differ in temperature need other torques.
  std::vector<std::string> shown;
  /// Effects of which the base has nothing, and which the recordings would show and don't: a check disagrees, none
  /// agrees.
  std::vector<std::string> refuted;
};

/// noise_rms_rad: deviation of repeats.
DirectEvidence direct_evidence(const std::vector<evidence::Signature>& checks, const sim::ActuatorParameters& base,
                               double noise_rms_rad);

}  // namespace pmg::diagnosis
