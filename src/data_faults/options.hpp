// The thresholds of the search for data faults.
#pragma once

#include <vector>

#include "evidence/option.hpp"

namespace pmg::data_faults {

/// listed() gives the unit, the reason and the data of each threshold.
struct DataFaultOptions {
  // Two columns against each other.
  double sure_correlation = 0.9, follows_correlation = 0.6, same_kind_share = 0.8;
  double unit_tolerance = 0.12, strange_factor = 1.8, slope_tolerance = 2.5;
  double sensor_lag_s = 0.04, shift_samples = 2.5, least_shift_s = 0.012, shift_rest = 0.3, longest_shift_s = 0.3;
  double law_factor = 3.0, command_difference = 0.02;
  // What the model says of a run.
  double clear_gain = 2.0, overwhelming_gain = 6.0, usual_error = 2.0, usual_deviations = 3.0,
         largest_usual_error = 5.0;
  double column_gain = 2.0;
  double model_shift_samples = 1.5, shift_gain = 1.6, lone_shift_gain = 2.5, longest_delay_s = 0.1;
  double row_gain = 1.5, pair_gain = 1.25;
  // Loads, gains and feed-forward.
  double least_mass_factor = 1.17, mass_gain = 1.25, least_gain_factor = 1.35, gain_gain = 1.3, damping_gain = 5.0;
  double least_common_gain = 2.2, better_than_common = 1.1, factor_deviations = 3.0;
  double least_exact_factor = 1.12, exact_floors = 1.4, exact_evidence = 30.0;
  double feed_forward_gain = 1.2;
  // Cost.
  double fitted_runs = 24.0, most_faults = 6.0;
};

std::vector<evidence::Option> listed(const DataFaultOptions& options);

}  // namespace pmg::data_faults
