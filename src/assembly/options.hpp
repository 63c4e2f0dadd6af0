// The thresholds of the search for what differs from assembly to assembly.
#pragma once

#include <vector>

#include "evidence/option.hpp"

namespace pmg::assembly {

/// listed() gives the reason of each.
struct AssemblyOptions {
  double fewest_runs = 2.0, most_levels = 30.0;
  double chance = 0.01, chance_without_a_run = 0.05, least_deviations = 2.0, least_folds_won = 0.6,
         amplitude_of_noise = 0.4;
  double apart_deviations = 2.0, told_share = 1e-3, most_varying = 3.0;
  double searched_runs = 80.0, iterations = 6.0;
};

std::vector<evidence::Option> listed(const AssemblyOptions& options);

}  // namespace pmg::assembly
