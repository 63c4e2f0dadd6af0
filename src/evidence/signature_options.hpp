// Thresholds of the model-free checks.
#pragma once

#include <vector>

#include "evidence/option.hpp"

namespace pmg::evidence {

/// When a command counts as a step.
struct StepOptions {
  double jump_ratio = 4.0, jump_share = 0.04;
};

/// Windows and directions of the torque balance.
struct BalanceOptions {
  double window_s = 0.2, fewest_points = 12.0, speed_window_s = 0.07;
  double still_deviations = 3.0, still_share = 0.01, moving_share = 0.7;
  double collinear_share = 0.01;
};

/// A command's dead time and rate limit.
struct ShapeOptions {
  double fewest_windows = 40.0, longest_delay_s = 0.1, slowest_limit = 0.4, fastest_limit = 4.0;
  double least_gain = 0.1, no_limit_gain = 0.05, least_delay_s = 0.002, least_delay_samples = 0.5;
};

/// The onset of motion after a step.
struct OnsetOptions {
  double rest_s = 0.15, fewest_rest_samples = 4.0, rest_of_noise = 4.0, rest_of_way = 0.1;
  double first_of_noise = 6.0, first_of_step = 0.02, last_of_step = 0.2, longest_s = 0.3;
  double fewest_steps = 4.0, least_delay_s = 0.003, least_delay_samples = 0.75;
};

/// Rests at a constant command.
struct RestOptions {
  double stood_s = 0.3, range_of_noise = 8.0, range_rad = 5e-4, fewest_rests = 8.0, gain_ratio = 1.5;
};

/// When a check refutes an effect, and when check and fit agree in size.
struct PowerOptions {
  double refuting_log_ratio = 4.5, compatible_deviations = 3.0;
  double size_deviations = 3.0, size_share = 0.5;
};

/// Each share is relative to the drive's root mean square. listed() gives units and reasons.
struct SignatureOptions {
  double sure_deviations = 4.0;
  double friction_share = 0.010, constant_share = 0.003, load_share = 0.006, drive_share = 0.012;
  double disagrees_share = 0.4;
  double own_share = 0.1;
  double fewest_clusters = 15.0;
  double slow_share = 0.15, reversal_s = 0.03;
  double gain_error = 0.05, gain_least = 0.1;
  double band_smallest_rad = 0.003, band_largest_rad = 0.1;
  double band_agrees_within = 0.4, band_possible_within = 0.5, band_disagrees_below = 0.6;
  double cogging_lowest_order = 3.0, cogging_highest_order = 60.0, cogging_false_alarms = 0.001;
  double cogging_own_share = 0.3;
  double thermal_range_K = 3.0, thermal_fewest_runs = 6.0;
  double rest_worth_rad = 1e-3;
  double swing_worth_share = 0.03;
  double swing_fewest_clusters = 6.0;
  double quantum_fewest_readings = 20.0;
  double quantum_rounding = 0.08;
  double quantum_multiples_share = 0.9;
  double quantum_coarse_rad = 1e-4;
  StepOptions step;
  BalanceOptions balance;
  ShapeOptions shape;
  OnsetOptions onset;
  RestOptions rest;
  PowerOptions power;
};

/// Every number of the struct, in its order; those of a struct within it as "balance.window_s".
std::vector<Option> listed(const SignatureOptions& options);

}  // namespace pmg::evidence
