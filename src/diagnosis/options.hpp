// The thresholds of a joint's diagnosis.
#pragma once

#include <vector>

#include "assembly/options.hpp"
#include "bench/odd_runs.hpp"
#include "calib/step_choice.hpp"
#include "effects/intervals.hpp"
#include "evidence/signature_options.hpp"
#include "residual_torque/options.hpp"

namespace pmg::diagnosis {

/// listed() gives the unit, the reason and the data of each threshold.
struct JointDiagnosisOptions {
  // When an effect is taken.
  double least_deviations = 3.0, least_folds_won = 0.6;
  double amplitude_of_noise = 1.2, amplitude_of_beginning = 0.1, gain_of_rest = 0.35;
  double scratch_amplitude_of_noise = 0.4, scratch_amplitude_of_beginning = 0.05, scratch_gain_of_rest = 0.1;
  double nearly_all_of_rest = 0.8, worse_deviations = 2.0, one_torque = 0.9;
  double equal_gain = 0.03, clearly_deviations = 3.0, regained_share = 0.5, most_effects = 6.0;
  // When two effects are told apart.
  double apart_deviations = 2.0, apart_share = 0.5, fewest_apart_blocks = 6.0, visible_share = 0.25;
  // When a form of an effect is taken.
  double better_form_deviations = 1.0, hopeless_form_deviations = 4.0;
  // The verdict.
  double remains_of_noise = 8.0, remains_of_beginning = 0.1;
  // When the readings alone decide.
  double coarser_quantum = 1.5, quantum_of_noise = 0.5;
  // The base model.
  double gain_tolerance = 0.02, damping_tolerance = 0.03, friction_tolerance = 0.1, load_tolerance = 0.02;
  double deviation_of_tolerance = 0.5;
  effects::IntervalOptions intervals;
  // The next excitation.
  double enough_deviations = 2.0, most_asked_runs = 6.0, most_asked_recordings = 24.0;
  // Cost limits of the search.
  double searched_runs = 40.0, fitted_effects = 8.0, exchanged_effects = 5.0, fitted_pairs = 5.0,
         finished_effects = 3.0;
  double worth_finishing = 0.4, worth_fitting_form = 0.7, few_iterations = 4.0, many_iterations = 15.0;
  double settled_squares = 0.995;

  assembly::AssemblyOptions assembly;
  bench::OddRunOptions odd_runs;
  calib::StepOptions step;
  evidence::SignatureOptions signatures;
  residual_torque::Options extension;
};

/// Every number of the struct, in its order; those of a struct within it at the end, as
/// "signatures.NAME".
std::vector<evidence::Option> listed(const JointDiagnosisOptions& options);

}  // namespace pmg::diagnosis
