// Model-free checks for and against causes.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/options.hpp"
#include "evidence/signature.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::diagnosis {

/// An effect whose parameter is read off the recordings. No fit decides on it: the effect may cause a limit cycle, and
/// no model knows its phase.
struct MeasuredCause {
  std::string effect, parameter;
  evidence::Interval value;  ///< of the parameter, in its own unit
};

struct DirectEvidence {
  /// Quantisation, where the readings' step is coarser than the base's and makes up a good part of the noise. A fine
  /// sensor's readings, too, are multiples of one number.
  std::vector<MeasuredCause> measured;
  /// Effects that the base model lacks and that a model-free check detects without a rival: thermal drift, where runs
  /// of different temperature need different torques.
  std::vector<std::string> shown;
  /// Effects that the base model lacks and that are ruled out: a model-free check should detect the effect and does
  /// not, and no other check detects it.
  std::vector<std::string> refuted;
};

/// noise_rms_rad: deviation of repeats.
DirectEvidence direct_evidence(const std::vector<evidence::Signature>& checks, const model::ActuatorParameters& base,
                               double noise_rms_rad, const JointDiagnosisOptions& options);

}  // namespace pmg::diagnosis
