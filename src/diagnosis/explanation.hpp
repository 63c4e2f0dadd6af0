// What is said of the effects that a search has chosen, and of the others.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/next_excitation.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

/// Two effects explain alike unless blocks left out, where the two differ, prefer one by so many deviations.
inline constexpr double kApartDeviations = 2.0;

struct ExplainedFrom {
  const NestedFit& searched;                       ///< the runs that the choice was made on
  const NestedFit& all;                            ///< and all that were fitted
  const NestedFit& judged;                         ///< those that errors are said of
  const NestedModel& fitted;                       ///< the chosen effects, to all runs
  const std::vector<evidence::Signature>& checks;  ///< without a model
  const NoiseFloor& noise;
  double error_after = 0.0;  ///< of the judged runs, with all causes [unit]
  std::string unit;
};

struct Explanation {
  std::vector<Cause> causes;  ///< the strongest first
  std::vector<Rejected> rejected;
  std::vector<Rivals> rivals;  ///< of each cause that can't be told apart
};

Explanation explain(EffectSearch& search, const Extension& chosen, const ExplainedFrom& from);

}  // namespace pmg::diagnosis
