#include "evidence/signature_options.hpp"

namespace pmg::evidence {

namespace {

constexpr const char* kRandom = "random joints without the effect (test/evidence/signature_test.cpp)";
constexpr const char* kAssumed = "assumed";
constexpr const char* kCost = "time of a diagnosis";

void add(std::vector<Option>& all, const StepOptions& o) {
  all.insert(all.end(),
             {{"step.jump_ratio", o.jump_ratio, "",
               "a command steps where it moves by so many times its move in the samples before and after", kAssumed},
              {"step.jump_share", o.jump_share, "", "and by more than this share of its range in the run", kAssumed}});
}

void add(std::vector<Option>& all, const BalanceOptions& o) {
  all.insert(
      all.end(),
      {{"balance.window_s", o.window_s, "s",
        "window of the torque balance: it averages sensor noise, yet is shorter than most motions", kAssumed},
       {"balance.fewest_points", o.fewest_points, "",
        "a window has at least so many points, or the sums are poor approximations of its integrals", kAssumed},
       {"balance.speed_window_s", o.speed_window_s, "s", "window of the speed that gives the direction of motion",
        kAssumed},
       {"balance.still_deviations", o.still_deviations, "",
        "a speed below so many standard deviations of its noise has no known direction", kAssumed},
       {"balance.still_share", o.still_share, "", "nor has a speed below this share of the run's fastest speed",
        kAssumed},
       {"balance.moving_share", o.moving_share, "", "share of a window that must move in a known direction", kAssumed},
       {"balance.collinear_share", o.collinear_share, "",
        "a column is collinear if the other columns leave less than this share of its norm", kAssumed}});
}

void add(std::vector<Option>& all, const ShapeOptions& o) {
  all.insert(
      all.end(),
      {{"shape.fewest_windows", o.fewest_windows, "", "windows that the search for delay and rate limit needs",
        kAssumed},
       {"shape.longest_delay_s", o.longest_delay_s, "s", "end of the search for a delay", kCost},
       {"shape.slowest_limit", o.slowest_limit, "",
        "the search for a rate limit begins at this share of the joint's fastest speed", kCost},
       {"shape.fastest_limit", o.fastest_limit, "", "and ends at this share", kCost},
       {"shape.least_gain", o.least_gain, "",
        "a delay or a limit is found if it removes this share of the balance's squared residual", kAssumed},
       {"shape.no_limit_gain", o.no_limit_gain, "",
        "a rate limit is ruled out if it removes surely less than this share", kAssumed},
       {"shape.least_delay_s", o.least_delay_s, "s", "a shorter delay is none", kAssumed},
       {"shape.least_delay_samples", o.least_delay_samples, "samples",
        "nor is a delay of fewer samples: a recording does not give the time of a command within a sample", kAssumed}});
}

void add(std::vector<Option>& all, const OnsetOptions& o) {
  all.insert(
      all.end(),
      {{"onset.rest_s", o.rest_s, "s", "a step from rest has readings at rest for so long before it", kAssumed},
       {"onset.fewest_rest_samples", o.fewest_rest_samples, "", "and so many of them", kAssumed},
       {"onset.rest_of_noise", o.rest_of_noise, "",
        "a reading is at rest within so many standard deviations of the sensor's noise", kAssumed},
       {"onset.rest_of_way", o.rest_of_way, "", "or within this share of the first distance that is fitted", kAssumed},
       {"onset.first_of_noise", o.first_of_noise, "",
        "the fit begins at a distance of so many standard deviations of the noise", kAssumed},
       {"onset.first_of_step", o.first_of_step, "", "and of this share of the step", kAssumed},
       {"onset.last_of_step", o.last_of_step, "",
        "the fit ends at this share of the step: the acceleration is constant only at first", kAssumed},
       {"onset.longest_s", o.longest_s, "s", "a joint that has not got so far by then is stuck or slow", kAssumed},
       {"onset.fewest_steps", o.fewest_steps, "", "steps that the check needs", kAssumed},
       {"onset.least_delay_s", o.least_delay_s, "s", "a shorter delay is none", kAssumed},
       {"onset.least_delay_samples", o.least_delay_samples, "samples",
        "nor is a delay of fewer samples: a recording gives neither the time of the command nor that of the reading "
        "within a sample",
        kAssumed}});
}

void add(std::vector<Option>& all, const RestOptions& o) {
  all.insert(
      all.end(),
      {{"rest.stood_s", o.stood_s, "s", "a joint has come to rest if its readings stay constant for so long", kAssumed},
       {"rest.range_of_noise", o.range_of_noise, "",
        "constant readings differ by at most so many standard deviations of the noise", kAssumed},
       {"rest.range_rad", o.range_rad, "rad", "or by at most this angle", kAssumed},
       {"rest.fewest_rests", o.fewest_rests, "", "rests that the check needs", kAssumed},
       {"rest.gain_ratio", o.gain_ratio, "",
        "ratio of the highest gain to the lowest that the check needs: it tells a dead band from friction", kAssumed}});
}

void add(std::vector<Option>& all, const PowerOptions& o) {
  all.insert(all.end(),
             {{"power.refuting_log_ratio", o.refuting_log_ratio, "",
               "a check refutes an effect from this logarithm of the likelihoods' ratio on: three deviations, 3^2 / 2",
               kAssumed},
              {"power.compatible_deviations", o.compatible_deviations, "",
               "and if its value is within so many deviations of the simulated joint's without the effect", kAssumed},
              {"power.size_deviations", o.size_deviations, "",
               "a check and a fit differ in size from so many deviations on", kAssumed},
              {"power.size_share", o.size_share, "", "and from this share of the larger of both sizes on", kAssumed}});
}

}  // namespace

std::vector<Option> listed(const SignatureOptions& o) {
  std::vector<Option> all = {
      {"sure_deviations", o.sure_deviations, "",
       "a check agrees from so many standard deviations on: one in 10000 by chance", kAssumed},
      {"friction_share", o.friction_share, "",
       "share of the drive that a term along the direction of motion must explain: sampling and a drive at its limit "
       "leave up to 0.8 % without friction",
       kRandom},
      {"constant_share", o.constant_share, "", "the same for constant torques and gravity", kRandom},
      {"load_share", o.load_share, "", "the same for the inertia of the load", kRandom},
      {"drive_share", o.drive_share, "",
       "the same for terms that follow the drive: without an effect up to 0.9 % remain", kRandom},
      {"disagrees_share", o.disagrees_share, "",
       "a check disagrees where a term explains surely less than this part of the share above", kAssumed},
      {"own_share", o.own_share, "", "of a term's rms that the other terms must not imitate", kAssumed},
      {"fewest_clusters", o.fewest_clusters, "", "stretches of motion that a balance of torques needs", kAssumed},
      {"slow_share", o.slow_share, "",
       "Stribeck friction is the friction that fades above this share of the joint's fastest speed", kAssumed},
      {"reversal_s", o.reversal_s, "s",
       "a joint with backlash lacks the drive's torque for so long after the torque reverses", kAssumed},
      {"gain_error", o.gain_error, "", "a gain that is wrong by less is right", kAssumed},
      {"gain_least", o.gain_least, "",
       "a load that takes a smaller share of its torque by the drive's account was not moved", kAssumed},
      {"band_smallest_rad", o.band_smallest_rad, "rad", "the search for a dead band begins here", kCost},
      {"band_largest_rad", o.band_largest_rad, "rad", "and ends here", kCost},
      {"band_agrees_within", o.band_agrees_within, "",
       "inside a dead band the gain's whole output is missing: a share within this much of 1 agrees", kAssumed},
      {"band_possible_within", o.band_possible_within, "",
       "a band whose missing share is within this much of 1 remains possible", kAssumed},
      {"band_disagrees_below", o.band_disagrees_below, "", "a share that is surely below this is friction", kAssumed},
      {"cogging_lowest_order", o.cogging_lowest_order, "per turn", "a wrong load imitates lower orders", kAssumed},
      {"cogging_highest_order", o.cogging_highest_order, "per turn", "end of the search", kCost},
      {"cogging_false_alarms", o.cogging_false_alarms, "", "false alarms over all orders together", kAssumed},
      {"cogging_own_share", o.cogging_own_share, "", "own_share of an order's two terms", kAssumed},
      {"thermal_range_K", o.thermal_range_K, "K", "range of temperatures that the check needs", kAssumed},
      {"thermal_fewest_runs", o.thermal_fewest_runs, "", "runs that the check needs: a run has about one temperature",
       kAssumed},
      {"rest_worth_rad", o.rest_worth_rad, "rad",
       "smallest dead band, or distance that friction leaves at the lowest gain, that a check names", kAssumed},
      {"swing_worth_share", o.swing_worth_share, "", "share of the swinging weight that friction must explain",
       kAssumed},
      {"swing_fewest_clusters", o.swing_fewest_clusters, "", "stretches of free swing that a check needs", kAssumed},
      {"quantum_fewest_readings", o.quantum_fewest_readings, "", "different readings that a check of their steps needs",
       kAssumed},
      {"quantum_rounding", o.quantum_rounding, "", "of a step: how far files may round a multiple of it", kAssumed},
      {"quantum_multiples_share", o.quantum_multiples_share, "",
       "share of the differences between readings that must be multiples of the step", kAssumed},
      {"quantum_coarse_rad", o.quantum_coarse_rad, "rad", "finer steps are no quantisation", kAssumed},
  };
  add(all, o.step);
  add(all, o.balance);
  add(all, o.shape);
  add(all, o.onset);
  add(all, o.rest);
  add(all, o.power);
  return all;
}

}  // namespace pmg::evidence
