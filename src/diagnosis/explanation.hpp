// Explains a search's result: causes with parameters and rivals, and reasons for the rejected effects.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/next_excitation.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

struct ExplainedFrom {
  const effects::NestedFit& searched;                ///< the runs of the search
  const effects::NestedFit& all;                     ///< all fitted runs
  const effects::NestedFit& judged;                  ///< the runs of the reported errors
  const effects::NestedModel& fitted;                ///< the chosen effects, fitted to all runs
  const std::vector<evidence::Signature>& checks;    ///< model-free
  const std::vector<evidence::Signature>& expected;  ///< the same of the simulated joint with all causes
  const calib::JointFloor& noise;
  const JointDiagnosisOptions& options;
  double error_after = 0.0;  ///< mean absolute error of the judged runs with all causes [unit]
  std::string unit;
};

struct Explanation {
  std::vector<Cause> causes;  ///< the strongest first
  std::vector<Rejected> rejected;
  std::vector<Rivals> rivals;  ///< for each ambiguous cause
};

Explanation explain(EffectSearch& search, const Extension& chosen, const ExplainedFrom& from);

}  // namespace pmg::diagnosis
