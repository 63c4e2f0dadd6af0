// Model-free checks for and against causes.
#pragma once

#include <map>
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
  /// Effects that the base model lacks and that a check says the recordings don't have, while no other check detects
  /// them. evidence::CheckPower says whether that rules out a fitted strength.
  std::vector<std::string> doubted;
  /// Effects that the base model lacks and that a check detects, with their strengths (effects::measured_strength;
  /// empty where the check has none). They get a full fit, whatever they explain to first order.
  std::map<std::string, std::vector<double>> evident;
};

/// True if the base model already contains the effect. A check detects an effect of the joint, not what the model
/// lacks.
bool in_base(const std::string& name, const model::ActuatorParameters& base);

/// noise_rms_rad: deviation of repeats. fastest_rad_s: of the recordings.
DirectEvidence direct_evidence(const std::vector<evidence::Signature>& checks, const model::ActuatorParameters& base,
                               double noise_rms_rad, double fastest_rad_s, const JointDiagnosisOptions& options);

}  // namespace pmg::diagnosis
