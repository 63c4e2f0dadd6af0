// Thresholds of the model-free checks.
#pragma once

#include <string_view>
#include <vector>

#include "work/threshold.hpp"

namespace pmg::evidence {

inline constexpr std::string_view kRandom = "random joints without the effect (test/evidence/signature_test.cpp)";
inline constexpr std::string_view kAssumed =
    "assumed; recordings of joints with each effect at a known strength would settle it";
inline constexpr std::string_view kCost = "time of a diagnosis";

/// When a command counts as a step.
struct StepOptions {
  work::Threshold jump_ratio{
      4.0, "", "a command steps where it moves by so many times its move in the samples before and after", kAssumed};
  work::Threshold jump_share{0.04, "", "and by more than this share of its range in the run", kAssumed};

  PMG_THRESHOLDS(jump_ratio, jump_share)
};

/// Windows and directions of the torque balance.
struct BalanceOptions {
  work::Threshold window_s{
      0.2, "s", "window of the torque balance: it averages sensor noise, yet is shorter than most motions", kAssumed};
  work::CountThreshold fewest_points{
      12, "", "a window has at least so many points, or the sums are poor approximations of its integrals", kAssumed};
  work::Threshold speed_window_s{0.07, "s", "window of the speed that gives the direction of motion", kAssumed};
  work::Threshold still_deviations{
      3.0, "", "a speed below so many standard deviations of its noise has no known direction", kAssumed};
  work::Threshold still_share{0.01, "", "nor has a speed below this share of the run's fastest speed", kAssumed};
  work::Threshold moving_share{0.7, "", "share of a window that must move in a known direction", kAssumed};
  work::Threshold collinear_share{
      0.01, "", "a column is collinear if the other columns leave less than this share of its norm", kAssumed};

  PMG_THRESHOLDS(window_s, fewest_points, speed_window_s, still_deviations, still_share, moving_share, collinear_share)
};

/// A command's dead time and rate limit.
struct ShapeOptions {
  work::CountThreshold fewest_windows{40, "", "windows that the search for delay and rate limit needs", kAssumed};
  work::Threshold longest_delay_s{0.1, "s", "end of the search for a delay", kCost};
  work::Threshold slowest_limit{0.4, "",
                                "the search for a rate limit begins at this share of the joint's fastest speed", kCost};
  work::Threshold fastest_limit{4.0, "", "and ends at this share", kCost};
  work::Threshold least_gain{
      0.1, "", "a delay or a limit is found if it removes this share of the balance's squared residual", kAssumed};
  work::Threshold no_limit_gain{0.05, "", "a rate limit is ruled out if it removes surely less than this share",
                                kAssumed};
  work::Threshold least_delay_s{0.002, "s", "shorter delays are reported as zero", kAssumed};
  work::Threshold least_delay_samples{
      0.5, "samples",
      "nor is a delay of fewer samples: a recording does not give the time of a command within a sample", kAssumed};

  PMG_THRESHOLDS(fewest_windows, longest_delay_s, slowest_limit, fastest_limit, least_gain, no_limit_gain,
                 least_delay_s, least_delay_samples)
};

/// The onset of motion after a step.
struct OnsetOptions {
  work::Threshold rest_s{0.15, "s", "a step from rest has readings at rest for so long before it", kAssumed};
  work::CountThreshold fewest_rest_samples{4, "", "and so many of them", kAssumed};
  work::Threshold rest_of_noise{
      4.0, "", "a reading is at rest within so many standard deviations of the sensor's noise", kAssumed};
  work::Threshold rest_of_way{0.1, "", "or within this share of the first distance that is fitted", kAssumed};
  work::Threshold first_of_noise{6.0, "", "the fit begins at a distance of so many standard deviations of the noise",
                                 kAssumed};
  work::Threshold first_of_step{0.02, "", "and of this share of the step", kAssumed};
  work::Threshold last_of_step{
      0.2, "", "the fit ends at this share of the step: the acceleration is constant only at first", kAssumed};
  work::Threshold longest_s{0.3, "s", "a joint that has not got so far by then is stuck or slow", kAssumed};
  work::CountThreshold fewest_steps{4, "", "steps that the check needs", kAssumed};
  work::Threshold least_delay_s{0.003, "s", "shorter delays are reported as zero", kAssumed};
  work::Threshold least_delay_samples{0.75, "samples",
                                      "nor is a delay of fewer samples: a recording gives neither the time of the "
                                      "command nor that of the reading within a sample",
                                      kAssumed};

  PMG_THRESHOLDS(rest_s, fewest_rest_samples, rest_of_noise, rest_of_way, first_of_noise, first_of_step, last_of_step,
                 longest_s, fewest_steps, least_delay_s, least_delay_samples)
};

/// Rests at a constant command.
struct RestOptions {
  work::Threshold stood_s{0.3, "s", "a joint has come to rest if its readings stay constant for so long", kAssumed};
  work::Threshold range_of_noise{
      8.0, "", "constant readings differ by at most so many standard deviations of the noise", kAssumed};
  work::Threshold range_rad{5e-4, "rad", "or by at most this angle", kAssumed};
  work::CountThreshold fewest_rests{8, "", "rests that the check needs", kAssumed};
  work::Threshold gain_ratio{
      1.5, "", "ratio of the highest gain to the lowest that the check needs: it tells a dead band from friction",
      kAssumed};

  PMG_THRESHOLDS(stood_s, range_of_noise, range_rad, fewest_rests, gain_ratio)
};

/// When a check refutes an effect, and when check and fit agree in size.
struct PowerOptions {
  work::Threshold refuting_log_ratio{
      4.5, "", "a check refutes an effect from this logarithm of the likelihoods' ratio on: three deviations, 3^2 / 2",
      kAssumed};
  work::Threshold compatible_deviations{
      3.0, "", "and if its value is within so many deviations of the simulated joint's without the effect", kAssumed};
  work::Threshold size_deviations{3.0, "", "a check and a fit differ in size from so many deviations on", kAssumed};
  work::Threshold size_share{0.5, "", "and from this share of the larger of both sizes on", kAssumed};

  PMG_THRESHOLDS(refuting_log_ratio, compatible_deviations, size_deviations, size_share)
};

/// Each share is relative to the drive's root mean square.
struct SignatureOptions {
  work::Threshold sure_deviations{4.0, "", "a check agrees from so many standard deviations on: one in 10000 by chance",
                                  kAssumed};
  work::Threshold friction_share{0.010, "",
                                 "share of the drive that a term along the direction of motion must explain: sampling "
                                 "and a drive at its limit leave up to 0.8 % without friction",
                                 kRandom};
  work::Threshold constant_share{0.003, "", "the same for constant torques and gravity", kRandom};
  work::Threshold load_share{0.006, "", "the same for the inertia of the load", kRandom};
  work::Threshold drive_share{
      0.012, "", "the same for terms that follow the drive: without an effect up to 0.9 % remain", kRandom};
  work::Threshold disagrees_share{
      0.4, "", "a check disagrees where a term explains surely less than this part of the share above", kAssumed};
  work::Threshold own_share{0.1, "", "of a term's rms that the other terms must not imitate", kAssumed};
  work::CountThreshold fewest_clusters{15, "", "stretches of motion that a balance of torques needs", kAssumed};
  work::Threshold slow_share{
      0.15, "", "Stribeck friction is the friction that fades above this share of the joint's fastest speed", kAssumed};
  work::Threshold reversal_s{
      0.03, "s", "a joint with backlash lacks the drive's torque for so long after the torque reverses", kAssumed};
  work::Threshold gain_error{0.05, "", "a gain that is wrong by less is right", kAssumed};
  work::Threshold gain_least{
      0.1, "", "a load that takes a smaller share of its torque by the drive's account was not moved", kAssumed};
  work::Threshold band_smallest_rad{0.003, "rad", "the search for a dead band begins here", kCost};
  work::Threshold band_largest_rad{0.1, "rad", "and ends here", kCost};
  work::Threshold band_agrees_within{
      0.4, "", "inside a dead band the gain's whole output is missing: a share within this much of 1 agrees", kAssumed};
  work::Threshold band_possible_within{0.5, "", "a band whose missing share is within this much of 1 remains possible",
                                       kAssumed};
  work::Threshold band_disagrees_below{0.6, "", "a share that is surely below this is friction", kAssumed};
  work::Threshold cogging_lowest_order{3.0, "per turn", "a wrong load imitates lower orders", kAssumed};
  work::Threshold cogging_highest_order{60.0, "per turn", "end of the search", kCost};
  work::Threshold cogging_false_alarms{0.001, "", "false alarms over all orders together", kAssumed};
  work::Threshold cogging_own_share{0.3, "", "own_share of an order's two terms", kAssumed};
  work::Threshold thermal_range_K{3.0, "K", "range of temperatures that the check needs", kAssumed};
  work::CountThreshold thermal_fewest_runs{6, "", "runs that the check needs: a run has about one temperature",
                                           kAssumed};
  work::Threshold rest_worth_rad{
      1e-3, "rad", "smallest dead band, or distance that friction leaves at the lowest gain, that a check names",
      kAssumed};
  work::Threshold swing_worth_share{0.03, "", "share of the swinging weight that friction must explain", kAssumed};
  work::CountThreshold swing_fewest_clusters{6, "", "stretches of free swing that a check needs", kAssumed};
  work::CountThreshold quantum_fewest_readings{20, "", "different readings that a check of their steps needs",
                                               kAssumed};
  work::Threshold quantum_rounding{0.08, "", "of a step: how far files may round a multiple of it", kAssumed};
  work::Threshold quantum_multiples_share{
      0.9, "", "share of the differences between readings that must be multiples of the step", kAssumed};
  work::Threshold quantum_coarse_rad{1e-4, "rad", "finer steps are no quantisation", kAssumed};
  StepOptions step;
  BalanceOptions balance;
  ShapeOptions shape;
  OnsetOptions onset;
  RestOptions rest;
  PowerOptions power;

  PMG_THRESHOLDS(sure_deviations, friction_share, constant_share, load_share, drive_share, disagrees_share, own_share,
                 fewest_clusters, slow_share, reversal_s, gain_error, gain_least, band_smallest_rad, band_largest_rad,
                 band_agrees_within, band_possible_within, band_disagrees_below, cogging_lowest_order,
                 cogging_highest_order, cogging_false_alarms, cogging_own_share, thermal_range_K, thermal_fewest_runs,
                 rest_worth_rad, swing_worth_share, swing_fewest_clusters, quantum_fewest_readings, quantum_rounding,
                 quantum_multiples_share, quantum_coarse_rad, step, balance, shape, onset, rest, power)
};

}  // namespace pmg::evidence
