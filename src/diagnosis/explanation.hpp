// What is said of the effects that a search has chosen, and of the others.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/next_excitation.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

struct ExplainedFrom {
  const effects::NestedFit& searched;              ///< the runs that the choice was made on
  const effects::NestedFit& all;                   ///< and all that were fitted
  const effects::NestedFit& judged;                ///< those that errors are said of
  const effects::NestedModel& fitted;              ///< the chosen effects, to all runs
  const std::vector<evidence::Signature>& checks;  ///< without a model
  const NoiseFloor& noise;
  const JointDiagnosisOptions& options;
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
