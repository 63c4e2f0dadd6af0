// The thresholds of the search for data faults.
#pragma once

#include <string_view>
#include <vector>

#include "work/threshold.hpp"

namespace pmg::data_faults {

inline constexpr std::string_view kPlants = "an earlier family of hidden plants, seeds 100 to 179";
inline constexpr std::string_view kLiterature = "hidden plants, even seeds 0 to 638";
inline constexpr std::string_view kAssumed =
    "assumed; measured benches with a known fault in their data would settle it";

struct DataFaultOptions {
  // Two columns against each other.
  work::Threshold sure_correlation{0.9, "",
                                   "two columns of which one follows from the other, as a speed from readings, are "
                                   "compared if they correlate so well",
                                   kAssumed};
  work::Threshold follows_correlation{
      0.6, "", "readings follow their commands if they correlate so well at the best lag", kAssumed};
  work::Threshold same_kind_share{0.8, "", "a fault is one of all runs if this share of them shows it", kAssumed};
  work::Threshold unit_tolerance{0.12, "", "logarithm by which a factor may miss a unit's or a firmware's", kAssumed};
  work::Threshold supply_tolerance{0.4, "",
                                   "logarithm by which a bus voltage may miss a unit's factor of the nominal one: "
                                   "batteries empty, sources sag",
                                   kAssumed};
  work::Threshold strange_factor{
      1.8, "", "a factor between two columns beyond it is another unit, though nobody knows which", kAssumed};
  work::Threshold slope_tolerance{2.5, "",
                                  "readings move by a unit's factor of their commands if they do so within this "
                                  "factor: a weak drive doesn't reach its commands",
                                  kAssumed};
  work::Threshold sensor_lag_s{0.04, "s", "a recorded speed may be so late: drives filter it", kAssumed};
  work::Threshold shift_samples{2.5, "", "samples by which a column must be early or late", kAssumed};
  work::Threshold least_shift_s{0.012, "s", "and the time", kPlants};
  work::Threshold shift_rest{
      0.3, "",
      "a shift between two columns counts if at most this share of what they don't explain of each other is left",
      kAssumed};
  work::Threshold longest_shift_s{0.3, "s", "shifts are looked for up to it", kAssumed};
  work::Threshold law_factor{
      3.0, "", "strange_factor of a recorded torque or voltage against the drive's law: gains are off by less",
      kAssumed};
  work::Threshold command_difference{
      0.02, "", "two recordings have the same commands if these differ by at most this share of their size", kAssumed};
  // Readings that stand still.
  work::Threshold frozen_quanta{5.0, "",
                                "readings that repeat are frozen if they jump by so many of the column's smallest "
                                "steps afterwards: a coarse sensor repeats by itself",
                                kLiterature};
  work::Threshold frozen_steps{2.0, "", "and by so many times each step of one sample beside it", kLiterature};
  work::Threshold frozen_tolerance{2.0, "", "and by at most so many times what the speed before or after explains",
                                   kLiterature};
  work::CountThreshold frozen_stretches{3, "", "and if one run shows it so many times", kLiterature};
  // What the model says of a run.
  work::Threshold clear_gain{
      2.0, "", "a sign, a unit or a row of one run is wrong if the correction divides the model's error by so much",
      kPlants};
  work::Threshold overwhelming_gain{6.0, "", "and if it divides it by so much", "random benches"};
  work::Threshold usual_error{2.0, "", "or if the error then is at most so many times the median over the runs",
                              kPlants};
  work::Threshold usual_deviations{3.0, "", "or within so many deviations of it", kPlants};
  work::Threshold largest_usual_error{5.0, "", "which count up to so many times the median", kPlants};
  work::Threshold column_gain{2.0, "", "clear_gain of a column of all runs", kPlants};
  work::Threshold model_shift_samples{
      1.5, "", "samples by which readings must be early or late of the model: one may be lost between two clocks",
      kLiterature};
  work::Threshold shift_gain{1.6, "", "clear_gain of a run's shift", kPlants};
  work::Threshold lone_shift_gain{2.5, "", "the same of a run that has no repeat: fast motion lags, too",
                                  "random benches"};
  work::Threshold longest_delay_s{0.1, "s", "a drive's delay is shorter", kAssumed};
  work::Threshold row_gain{
      1.5, "", "two rows stand for each other if exchanging them divides both errors by so much, in the geometric mean",
      kPlants};
  work::Threshold pair_gain{1.25, "", "and each by so much", kPlants};
  // Loads, gains and feed-forward.
  work::Threshold least_mass_factor{1.17, "", "a load's mass is wrong from this factor on", kAssumed};
  work::Threshold mass_gain{1.25, "", "and if its correction divides the error on the load's runs by so much", kPlants};
  work::Threshold least_gain_factor{1.35, "", "a gain acts by another factor from this one on", kPlants};
  work::Threshold gain_gain{1.3, "", "and if its correction divides the error on the gain's runs by so much", kPlants};
  work::Threshold damping_gain{5.0, "", "the same of kd: friction, lags and speed limits look like damping", kPlants};
  work::Threshold least_common_gain{
      2.2, "", "all gains act by another factor from this one on: less is the effect `gain`", kAssumed};
  work::Threshold better_than_common{1.1, "",
                                     "one load or gain is wrong if its factor leaves an error so many times smaller on "
                                     "its runs than one factor for all loads or gains does",
                                     kPlants};
  work::Threshold factor_deviations{3.0, "", "and if the gain of its runs is so many standard deviations of its mean",
                                    kPlants};
  work::Threshold least_exact_factor{
      1.12, "",
      "a smaller factor of a gain or a load is believed from here on, if its correction leaves nothing to explain",
      "loads and gains are read off with less error"};
  work::Threshold exact_floors{
      1.4, "", "which is so if the usual error then is at most so many times what repeats differ by", kLiterature};
  work::Threshold exact_evidence{
      30.0, "", "and twice the logarithm of the likelihood grows by so much, over no factor and over one effect",
      "five and a half deviations"};
  work::Threshold others_within{
      0.5, "",
      "beside the model of a diagnosis one load or gain is wrong if the factors of all others are within this share of "
      "how far it stands apart from them: physics that depends on the load is a trend",
      kAssumed};
  work::Threshold feed_forward_gain{
      1.2, "", "the feed-forward has another unit or sign if its correction divides the error on its runs by so much",
      kPlants};
  // Cost.
  work::CountThreshold fitted_runs{24, "", "runs that the quick model is fitted to", "time of a diagnosis"};
  work::CountThreshold most_faults{6, "", "faults that the model is asked for, one after the other", kAssumed};

  PMG_THRESHOLDS(sure_correlation, follows_correlation, same_kind_share, unit_tolerance, supply_tolerance,
                 strange_factor, slope_tolerance, sensor_lag_s, shift_samples, least_shift_s, shift_rest,
                 longest_shift_s, law_factor, command_difference, frozen_quanta, frozen_steps, frozen_tolerance,
                 frozen_stretches, clear_gain, overwhelming_gain, usual_error, usual_deviations, largest_usual_error,
                 column_gain, model_shift_samples, shift_gain, lone_shift_gain, longest_delay_s, row_gain, pair_gain,
                 least_mass_factor, mass_gain, least_gain_factor, gain_gain, damping_gain, least_common_gain,
                 better_than_common, factor_deviations, least_exact_factor, exact_floors, exact_evidence, others_within,
                 feed_forward_gain, fitted_runs, most_faults)
};

}  // namespace pmg::data_faults
