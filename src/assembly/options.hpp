// The thresholds of the search for what differs from assembly to assembly.
#pragma once

#include <string_view>
#include <vector>

#include "work/threshold.hpp"

namespace pmg::assembly {

inline constexpr std::string_view kAssumed = "assumed; one joint built several times, each measured, would settle it";
inline constexpr std::string_view kCost = "time of a diagnosis";

struct AssemblyOptions {
  work::CountThreshold fewest_runs{2, "", "a value of a column counts if it has so many runs: one run has no scatter",
                                   kAssumed};
  work::CountThreshold most_levels{30, "", "a column with more values is a measurement, not an assembly", kAssumed};
  work::Threshold chance{0.01, "",
                         "a parameter varies if chance alone makes its levels as different as this in less than this "
                         "share of benches, all parameters and columns that were tried counted (C. E. Bonferroni 1936)",
                         "usual level of significance"};
  work::Threshold chance_without_a_run{
      0.05, "", "and if, whichever single run is left out, the chance stays below this: one odd run makes no level",
      "usual level of significance"};
  work::Threshold least_deviations{
      2.0, "",
      "and if runs left out, others of whose level stay in, are predicted better by so many standard deviations",
      "usual level of significance; chance counts the number of tests already"};
  work::Threshold least_folds_won{0.6, "", "and in this share of the folds", "as for an effect"};
  work::Threshold amplitude_of_noise{
      0.4, "", "and if the square root of the gain is so many times the rms noise: less is of no use to a simulation",
      "as for an effect that is searched from scratch"};
  work::Threshold apart_deviations{2.0, "",
                                   "two parameters, or two columns, are told apart if one predicts runs left out "
                                   "better by so many standard deviations",
                                   "as for effects"};
  work::Threshold told_share{1e-3, "",
                             "a mean over the levels is fitted if this share of what it does to the rollouts can't be "
                             "done by the model's other numbers",
                             "assumed: a variance inflation of 1000"};
  work::CountThreshold most_varying{3, "", "parameters that one joint's assemblies may differ in", kAssumed};
  work::CountThreshold searched_runs{80, "", "runs that the variation is searched on; its levels are fitted to all",
                                     kCost};
  work::CountThreshold iterations{6, "", "Gauss-Newton iterations of the fit of all levels", kCost};

  PMG_THRESHOLDS(fewest_runs, most_levels, chance, chance_without_a_run, least_deviations, least_folds_won,
                 amplitude_of_noise, apart_deviations, told_share, most_varying, searched_runs, iterations)
};

}  // namespace pmg::assembly
