#include "assembly/options.hpp"

namespace pmg::assembly {

std::vector<evidence::Option> listed(const AssemblyOptions& o) {
  const char* assumed = "assumed";
  const char* cost = "time of a diagnosis";
  return {
      {"fewest_runs", o.fewest_runs, "", "a value of a column counts if it has so many runs: one run has no scatter",
       assumed},
      {"most_levels", o.most_levels, "", "a column with more values is a measurement, not an assembly", assumed},
      {"chance", o.chance, "",
       "a parameter varies if chance alone makes its levels as different as this in less than this share of benches, "
       "all parameters and columns that were tried counted (C. E. Bonferroni 1936)",
       "usual level of significance"},
      {"chance_without_a_run", o.chance_without_a_run, "",
       "and if, whichever single run is left out, the chance stays below this: one odd run makes no level",
       "usual level of significance"},
      {"least_deviations", o.least_deviations, "",
       "and if runs left out, others of whose level stay in, are predicted better by so many standard deviations",
       "usual level of significance; chance counts the number of tests already"},
      {"least_folds_won", o.least_folds_won, "", "and in this share of the folds", "as for an effect"},
      {"amplitude_of_noise", o.amplitude_of_noise, "",
       "and if the square root of the gain is so many times the rms noise: less is of no use to a simulation",
       "as for an effect that is searched from scratch"},
      {"apart_deviations", o.apart_deviations, "",
       "two parameters, or two columns, are told apart if one predicts runs left out better by so many standard "
       "deviations",
       "as for effects"},
      {"told_share", o.told_share, "",
       "a mean over the levels is fitted if this share of what it does to the rollouts can't be done by the model's "
       "other numbers",
       "assumed: a variance inflation of 1000"},
      {"most_varying", o.most_varying, "", "parameters that one joint's assemblies may differ in", assumed},
      {"searched_runs", o.searched_runs, "", "runs that the variation is searched on; its levels are fitted to all",
       cost},
      {"iterations", o.iterations, "", "Gauss-Newton iterations of the fit of all levels", cost},
  };
}

}  // namespace pmg::assembly
