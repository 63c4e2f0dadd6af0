// What every diagnosis says in the same words: a verdict, numbers with intervals.
#pragma once

#include <string>

namespace pmg::evidence {

enum class Verdict {
  kFound,        ///< the causes are these
  kAmbiguous,    ///< at least one cause can't be told from another with this data: record next_excitation
  kNone,         ///< nothing beyond noise
  kUnexplained,  ///< something real remains that no effect of the catalogue explains
};

/// found, ambiguous, none, unexplained.
const char* name(Verdict verdict);

/// A number and where it lies with 95 % probability.
struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// One parameter of an effect. The name is one of model::actuator_parameters, or load.inertia_scale,
/// load.gravity_scale.
struct ParameterEstimate {
  std::string name;
  Interval estimate;
  std::string unit;
};

}  // namespace pmg::evidence
