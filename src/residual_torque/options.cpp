#include "residual_torque/options.hpp"

namespace pmg::residual_torque {

std::vector<evidence::Option> listed(const Options& o) {
  const char* plants = "plants off the catalogue, even seeds 0 to 440";  // docs/explanation/hidden-plants.md
  const char* assumed = "assumed";
  const char* cost = "time of a diagnosis";
  return {
      {"bound_of_peak", o.bound_of_peak, "",
       "no value of a residual torque exceeds this share of the largest torque that the drive nominally gave", assumed},
      {"curve_knots", o.curve_knots, "", "knots of a residual torque over one quantity", cost},
      {"map_knots", o.map_knots, "", "knots of each axis of one over two quantities", cost},
      {"map_modes", o.map_modes, "", "smooth modes that a map is made of", cost},
      {"least_repeating", o.least_repeating, "",
       "a torque over the phase of a period in time is a candidate if the period explains this share of what is "
       "missing",
       assumed},
      {"least_repeats", o.least_repeats, "", "and repeats so often in the longest run", assumed},
      {"shortest_period_s", o.shortest_period_s, "s", "shortest period looked for: a few samples of a slow bench",
       cost},
      {"fitted_candidates", o.fitted_candidates, "",
       "curves and maps that rollouts are fitted with: the best by the torque that the recordings ask for", cost},
      {"worth_fitting", o.worth_fitting, "",
       "share of the best one's gain from which the next is fitted to rollouts, too", cost},
      {"iterations", o.iterations, "", "Gauss-Newton iterations of such a fit", cost},
      {"least_deviations", o.least_deviations, "",
       "a residual torque is kept if its mean gain over blocks left out (of rms errors) is so many of its standard "
       "deviations: less than a cause needs, because it names nothing",
       plants},
      {"least_folds_won", o.least_folds_won, "", "and if it is better in this share of the folds", plants},
  };
}

}  // namespace pmg::residual_torque
