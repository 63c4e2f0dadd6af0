// What a diagnosis is worth.
#include <fmt/format.h>

#include "calib/fit_results.hpp"
#include "data_faults/data_faults_report.hpp"
#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis {

work::Worth worth_of(const Diagnosis& diagnosis) {
  work::Worth worth = data_faults::worth_of(diagnosis.data);
  const double before = diagnosis.held_out_before.value, after = diagnosis.held_out_after.value;
  switch (diagnosis.verdict) {
    case evidence::Verdict::kInterrupted:
      worth.add(work::Grade::kInterrupted,
                "the search was ended before it could tell what is wrong, or that nothing is");
      break;
    case evidence::Verdict::kUnexplained:
      worth.add(work::Grade::kMissed, "no effect of the list explains what is left");
      break;
    case evidence::Verdict::kAmbiguous:
      worth.add(work::Grade::kOpen, "these recordings don't tell all causes apart");
      break;
    case evidence::Verdict::kFound:
    case evidence::Verdict::kNone:
      break;
  }
  worth.add_if(!diagnosis.causes.empty() && !(after < before), work::Grade::kNoBetter,
               "the simulation is no better with the causes than without them");
  const double still = diagnosis.standing_still;
  worth.add_if(
      still > 0.0 && !(after < calib::kExplainedShare * still), work::Grade::kOffItsData,
      fmt::format("the simulation misses the readings by {:.3g} m{}, a joint that stands still would by {:.3g}",
                  1e3 * after, diagnosis.unit, 1e3 * still));
  return worth;
}

}  // namespace pmg::diagnosis
