// Results that both diagnoses share: verdict, interval, parameter estimate.
#pragma once

#include <string>

namespace pmg::evidence {

enum class Verdict {
  kFound,        ///< the causes are identified
  kAmbiguous,    ///< these data cannot tell at least one cause from another: record next_excitation
  kNone,         ///< the residual is noise
  kUnexplained,  ///< the residual exceeds the noise, and no effect of the catalogue explains it
  kInterrupted,  ///< the search was ended before it could tell
};

/// found, ambiguous, none, unexplained, interrupted.
const char* name(Verdict verdict);

/// A value with its 95 % interval.
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

/// "0.1016 (0.07796 to 0.1053) rad", with so many significant digits.
std::string text_of(const Interval& interval, const std::string& unit, int digits);

}  // namespace pmg::evidence
