// Thresholds of a residual torque's fit.
#pragma once

#include <vector>

#include "evidence/option.hpp"

namespace pmg::residual_torque {

/// listed() gives the unit, the reason and the data of each.
struct Options {
  double bound_of_peak = 0.5;
  double curve_knots = 20.0, map_knots = 8.0, map_modes = 16.0;
  double least_repeating = 0.1, least_repeats = 3.0, shortest_period_s = 0.125;
  double fitted_candidates = 3.0, worth_fitting = 0.5, iterations = 8.0;
  double least_deviations = 2.0, least_folds_won = 0.6;
};

std::vector<evidence::Option> listed(const Options& options);

}  // namespace pmg::residual_torque
