// Result of a bench's diagnosis: the verdict, the causes of the simulation's error, and the error with and without
// them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assembly/variation.hpp"
#include "calib/joint_floor.hpp"
#include "calib/step_choice.hpp"
#include "data_faults/examine.hpp"
#include "diagnosis/options.hpp"
#include "evidence/verdict.hpp"
#include "residual_torque/extension.hpp"
#include "work/worth.hpp"

namespace pmg::diagnosis {

/// An effect that the model lacked. Errors are mean absolute errors of open-loop rollouts over the held-out runs [rad;
/// m on a linear axis]: of the model without this effect, refitted, and of the whole model.
struct Cause {
  std::string effect;                        ///< of the catalogue
  std::string form;                          ///< of effects::Effect::forms: the one in the model
  std::vector<std::string> form_or_instead;  ///< forms of the same effect that explain the runs as well
  std::vector<evidence::ParameterEstimate> parameters;
  double held_out_error_before = 0.0, held_out_error_after = 0.0;
  std::vector<std::string> evidence;    ///< sentences: folds won, and model-free checks that agree or disagree
  std::vector<std::string> or_instead;  ///< rival effects that explain the runs as well; empty if there is none
  std::vector<std::string> same_here;   ///< effects that no run on this rig can separate from this one
};

/// How an effect was looked at that is no cause.
enum class LookedAt {
  kFit,         ///< fitted beside the causes
  kRecordings,  ///< read off the recordings, which tell it without a fit
  kLinearised,  ///< only by a linearised fit: not ruled out
  kNot,         ///< not at all: not ruled out
};

/// fit, recordings, linearised, no.
const char* name(LookedAt looked_at);

struct Rejected {
  std::string effect;
  std::string why;
  LookedAt looked_at = LookedAt::kNot;
};

/// A run to record next.
struct NextRun {
  std::string name;           ///< of the trajectory
  std::string shape;          ///< of the command, in words
  int times = 1;              ///< how often to record it; all repeats are to be fitted
  double kp = 1.0, kd = 0.0;  ///< gains to set on the drive, as BenchRun's
  bench::JointLoad load;
  double load_mass_kg = 0.0, load_length_m = 0.0;  ///< as in runs.csv; 0 on a bench without loads
  std::vector<double> t_s, q_cmd_rad;
};

/// Expected separation of two effects once the next runs are recorded.
struct ExpectedPair {
  std::string first, second;
  double deviations = 0.0;  ///< of their comparison on left-out blocks; 2 or more separate them
};

/// A small campaign to record next, and the effects that it separates.
struct NextExcitation {
  std::string text;  ///< one line for the engineer
  std::vector<std::string> tells_apart;
  std::vector<NextRun> runs;
  std::vector<ExpectedPair> pairs;
};

struct Diagnosis {
  data_faults::Examination data;  ///< faults of the data, and what the verdict was found with
  evidence::Verdict verdict = evidence::Verdict::kNone;
  std::vector<Cause> causes;  ///< the strongest first
  std::vector<Rejected> rejected;
  std::optional<residual_torque::Extension> residual_extension;  ///< tried where the verdict is unexplained
  calib::JointFloor noise_floor;                                 ///< with the integrator's error
  calib::ChosenStep step;                                        ///< of the simulation, chosen on the base model
  calib::IntegrationError step_error_after;                      ///< of this step, with all causes
  /// Mean absolute errors over the held-out runs with block-bootstrap intervals; over folds where nothing was held out.
  evidence::Interval held_out_before, held_out_after;
  double standing_still = 0.0;  ///< the same of a joint that does nothing (calib::standing_still); 0: not measured
  bool held_out = false;        ///< true if runs were held out; else the two errors above are from folds
  double share_of_way_to_floor = 0.0;  ///< (before - after) / (before - floor)
  /// rms residual of the fitted runs (geometric mean over half-second blocks) over the rms noise: 1 if only noise is
  /// left.
  double before_over_noise = 1.0, after_over_noise = 1.0;
  assembly::AssemblyDifferences assemblies;  ///< parameters that differ from assembly to assembly
  std::vector<std::string> depends_on;  ///< quantities that the remaining residual depends on: velocity, position, ...
  std::optional<NextExcitation> next_excitation;
  std::string unit = "rad";
  calib::JointModel before, after;
  std::vector<std::string> base_parameters;  ///< fitted with and without effects
  JointDiagnosisOptions options;             ///< thresholds in force
};

/// Interrupted; off its data, where these have faults or the simulation explains no motion (calib::kExplainedShare); no
/// better with the causes; missed, where the verdict is unexplained; open, where causes can't be told apart.
work::Worth worth_of(const Diagnosis& diagnosis);

}  // namespace pmg::diagnosis
