// The thresholds of a joint's diagnosis.
#pragma once

#include <string_view>
#include <vector>

#include "assembly/options.hpp"
#include "bench/odd_runs.hpp"
#include "calib/step_choice.hpp"
#include "data_faults/options.hpp"
#include "effects/intervals.hpp"
#include "evidence/signature_options.hpp"
#include "evidence/thresholds.hpp"
#include "residual_torque/options.hpp"
#include "work/threshold.hpp"

namespace pmg::diagnosis {

// docs/explanation/hidden-plants.md
inline constexpr std::string_view kPlants = "an earlier family of hidden plants, seeds 0 to 83";
inline constexpr std::string_view kAssumed = "assumed; measured joints whose effects are known would settle it";
inline constexpr std::string_view kCost = "time of a diagnosis";

struct JointDiagnosisOptions {
  // When an effect is taken.
  work::Threshold least_deviations{
      3.0, "", "an effect is taken if its mean gain over blocks left out is so many of its standard deviations",
      kPlants};
  work::Threshold least_folds_won{0.6, "", "and if it is better in this share of the folds", kPlants};
  work::Threshold amplitude_of_noise{1.2, "", "and if the square root of its gain is so many times the noise", kPlants};
  work::Threshold amplitude_of_beginning{0.1, "", "and this share of the residual before any effect", kPlants};
  work::Threshold mean_of_few_blocks{
      10.0, "",
      "from this ratio of that residual's mean square to its usual one, a few blocks have most of it, as where a joint "
      "swings by itself: then the share of usual blocks counts as well",
      "hidden plants with two effects"};
  work::Threshold gain_of_rest{0.35, "",
                               "and if its gain is this share of the residual beyond a correct model's: an effect "
                               "whose form isn't quite right leaves a rest that a second one could mend",
                               kPlants};
  work::Threshold scratch_amplitude_of_noise{
      0.4, "", "amplitude_of_noise without a model: several effects are expected, the weaker beside the stronger",
      kPlants};
  work::Threshold scratch_amplitude_of_beginning{0.05, "", "amplitude_of_beginning without a model", kPlants};
  work::Threshold scratch_gain_of_rest{0.1, "", "gain_of_rest without a model", kPlants};
  work::Threshold nearly_all_of_rest{0.75, "",
                                     "from this share of the residual beyond a correct model's, amplitude_of_beginning "
                                     "doesn't count: what mends another effect's form leaves a rest itself; only where "
                                     "the residual without the effect is above remains_of_noise",
                                     "hidden plants with two effects"};
  work::Threshold all_of_rest{
      0.95, "",
      "and from this share, wherever the residual is, where no effect is taken otherwise and it "
      "is better than every other by clearly_deviations: what mends a form has rivals",
      "hidden plants with two effects"};
  work::Threshold all_of_rest_deviations{
      6.0, "",
      "and if its gain is so many of its deviations; with as many, what remains on average counts as what remains in "
      "usual blocks, too",
      "hidden plants with two effects"};
  work::Threshold halved_log_gain{
      0.69, "",
      "or if with nearly_all_of_rest and all_of_rest_deviations the logarithm of the mean square in usual blocks, "
      "noise included, falls by so much: repeats differ by more than a right model leaves where each starts elsewhere",
      "hidden plants, used odd seeds: of 52 with two effects it takes in none that is not there"};
  work::Threshold deviations_on_trial{2.0, "",
                                      "or of so many, on trial: judged again once what it needs beside it is there",
                                      "hidden plants with two effects"};
  work::Threshold worse_deviations{2.0, "",
                                   "an effect is not taken if runs of a gain, a load or a trajectory left out are "
                                   "predicted worse with it, by so many standard deviations",
                                   kAssumed};
  work::Threshold one_torque{
      0.9, "",
      "two effects are one torque if the squared cosine of what they do to the rollouts, beyond what the other numbers "
      "can do, is larger: a variance inflation of ten (D. W. Marquardt, Technometrics 12:591, 1970)",
      kAssumed};
  work::Threshold equal_gain{0.03, "", "gains that differ by less than this share are equal: fewer parameters decide",
                             kPlants};
  work::Threshold clearly_deviations{
      3.0, "", "an effect replaces another, or its special case, if it is better by so many standard deviations",
      kPlants};
  work::Threshold regained_share{
      0.5, "", "a fit without the newest effect that regains this share of its gain was not at its end", kPlants};
  work::Threshold stays_at_half_step{
      0.5, "",
      "an effect that explains less than the integrator's error is taken if half the step leaves this share of its "
      "gain: what mends an error of first order loses three quarters",
      "arithmetic"};
  work::CountThreshold most_effects{6, "", "effects that one joint may have", kAssumed};
  // When two effects are told apart.
  work::Threshold apart_deviations{
      2.0, "", "two effects are told apart if one is better by so many standard deviations", kPlants};
  work::Threshold apart_share{0.5, "", "and by this share of what is expected were it the truth", kPlants};
  work::CountThreshold fewest_apart_blocks{6, "", "on at least so many blocks of half a second in which the two differ",
                                           kPlants};
  work::Threshold visible_share{
      0.25, "", "two rollouts differ in a block if the square of their difference is this share of the residual's",
      kPlants};
  // When a form of an effect is taken.
  work::Threshold better_form_deviations{
      1.0, "",
      "a form of an effect replaces a simpler one if it is better by so many standard deviations: less is a tie",
      kAssumed};
  work::Threshold hopeless_form_deviations{
      4.0, "", "a form that is worse by so many standard deviations after a first fit is not fitted to its end", kCost};
  // The verdict.
  work::Threshold remains_of_noise{6.0, "",
                                   "a residual of less than so many times the noise's mean square is not called "
                                   "unexplained: loads are weighed to a percent, friction changes from day to day",
                                   "hidden plants: of those without a cause sound joints leave at most 4.8"};
  work::Threshold remains_of_beginning{
      0.03, "", "nor is one of less than this share of the beginning: an effect's form isn't quite the catalogue's",
      "hidden plants, used odd seeds: causes that are right leave at most 2 % of what is strong"};
  work::Threshold causes_leave_of_noise{3.0, "",
                                        "causes that leave more than so many times the noise's mean square, and more "
                                        "than causes_leave_of_beginning, explain nothing: the verdict is unexplained",
                                        "hidden plants, used odd seeds: sound joints leave as much, without a cause"};
  work::Threshold causes_leave_of_beginning{0.25, "", "this share of the beginning",
                                            "hidden plants, used odd seeds: right causes leave at most 0.17 of it"};
  work::Threshold without_cause_of_floor{
      3.0, "",
      "a model without causes that misses the judged runs by more than so many noise floors, on average, is "
      "unexplained: what a joint does in few blocks its usual ones don't show",
      "hidden plants, used odd seeds: of 177 sound joints one misses them by 2.6, the others by at most 2.2"};
  // When the readings alone decide.
  work::Threshold coarser_quantum{
      1.5, "",
      "readings show quantisation if their step is so many times the known one: sensors halve or double theirs",
      kPlants};
  work::Threshold quantum_of_noise{0.5, "", "and if rounding to it makes up this share of the noise's deviation",
                                   kPlants};
  // The base model.
  work::Threshold gain_tolerance{
      0.02, "", "of the value: how well the base model's gains and torque constants are known", kAssumed};
  work::Threshold damping_tolerance{0.03, "", "the same of a drive's damping and back-EMF", kAssumed};
  work::Threshold friction_tolerance{
      0.1, "",
      "the same of friction, delay and the rotor's inertia, which change from day to day or come from a data sheet",
      kAssumed};
  work::Threshold load_tolerance{0.02, "", "the same of loads", kAssumed};
  work::Threshold deviation_of_tolerance{
      0.5, "", "one standard deviation of such a number, as a share of its tolerance", kAssumed};
  work::Threshold constant_gain_of_rest{
      0.5, "", "a constant of the model is free from the start if it explains this share of what is left", kAssumed};
  work::Threshold stiffer_presliding{10.0, "",
                                     "dry friction may give way by so many times less than the model or the default "
                                     "say before it slides: a joint that "
                                     "sticks ideally gives way by too little to be seen",
                                     kAssumed};
  work::Threshold softer_presliding{3.0, "", "or by so many times more; this ratio is one standard deviation",
                                    kAssumed};
  effects::IntervalOptions intervals;
  // The next excitation.
  work::Threshold enough_deviations{
      2.0, "", "what is asked for should part two effects by so many times apart_deviations: the outcome strays by one",
      kAssumed};
  work::CountThreshold most_asked_runs{6, "", "different runs that are asked for at once", kAssumed};
  work::CountThreshold most_asked_recordings{24, "", "recordings of them", kAssumed};
  // Cost limits of the search.
  work::CountThreshold searched_runs{40, "", "runs that effects are chosen on; the result is fitted to all", kCost};
  work::CountThreshold fitted_effects{8, "", "effects of a round that are fitted, the best by their linearisation",
                                      kCost};
  work::CountThreshold exchanged_effects{5, "", "effects that are fitted in the place of a cause", kCost};
  work::CountThreshold fitted_pairs{
      30, "",
      "pairs of effects that are fitted where no single effect explains a rest, the best by their linearisation",
      kCost};
  work::CountThreshold finished_pairs{4, "", "pairs whose fits are continued to their end", kCost};
  work::CountThreshold finished_effects{3, "", "effects whose fits are continued to their end", kCost};
  work::Threshold worth_finishing{0.4, "", "share of the best gain from which a fit is continued", kCost};
  work::Threshold worth_fitting_form{
      0.7, "", "a further form of an effect is fitted if its start explains this share of what the best start explains",
      kCost};
  work::CountThreshold few_iterations{4, "", "Gauss-Newton iterations of a first fit", kCost};
  work::CountThreshold many_iterations{15, "", "of a fit to its end", kCost};
  work::Threshold settled_squares{
      0.995, "",
      "rivals are fitted again about the fit with priors if its squares are below this share of the search's", kCost};

  assembly::AssemblyOptions assembly;
  bench::OddRunOptions odd_runs;
  calib::StepOptions step;
  evidence::SignatureOptions signatures;
  residual_torque::Options extension;

  PMG_THRESHOLDS(least_deviations, least_folds_won, amplitude_of_noise, amplitude_of_beginning, mean_of_few_blocks,
                 gain_of_rest, scratch_amplitude_of_noise, scratch_amplitude_of_beginning, scratch_gain_of_rest,
                 nearly_all_of_rest, all_of_rest, all_of_rest_deviations, halved_log_gain, deviations_on_trial,
                 worse_deviations, one_torque, equal_gain, clearly_deviations, regained_share, stays_at_half_step,
                 most_effects, apart_deviations, apart_share, fewest_apart_blocks, visible_share,
                 better_form_deviations, hopeless_form_deviations, remains_of_noise, remains_of_beginning,
                 causes_leave_of_noise, causes_leave_of_beginning, without_cause_of_floor, coarser_quantum,
                 quantum_of_noise, gain_tolerance, damping_tolerance, friction_tolerance, load_tolerance,
                 deviation_of_tolerance, constant_gain_of_rest, stiffer_presliding, softer_presliding, intervals,
                 enough_deviations, most_asked_runs, most_asked_recordings, searched_runs, fitted_effects,
                 exchanged_effects, fitted_pairs, finished_pairs, finished_effects, worth_finishing, worth_fitting_form,
                 few_iterations, many_iterations, settled_squares, assembly, odd_runs, step, signatures, extension)
};

/// Every row of both by its name for --set: a joint's as they are, the data's as "data_faults.NAME".
evidence::ThresholdRows rows(JointDiagnosisOptions& joint, data_faults::DataFaultOptions& data);

}  // namespace pmg::diagnosis
