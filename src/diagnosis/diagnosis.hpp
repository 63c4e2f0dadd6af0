// What a diagnosis of a bench says: what the simulation gets wrong, why, and how much better it is once that is known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "evidence/option.hpp"
#include "evidence/verdict.hpp"

namespace pmg::diagnosis {

/// An effect that the simulation lacked. Errors are mean absolute ones of open-loop rollouts [rad; m on a linear axis]
/// over the held-out runs: of the whole model without this effect (the rest fitted again), and with it.
struct Cause {
  std::string effect;  ///< of the catalogue
  std::vector<evidence::ParameterEstimate> parameters;
  double held_out_error_before = 0.0, held_out_error_after = 0.0;
  std::vector<std::string> evidence;    ///< sentences: folds won, and model-free checks that agree or disagree
  std::vector<std::string> or_instead;  ///< effects that explain as much as this one; empty where it is told apart
  std::vector<std::string> same_here;  ///< effects that no run on this rig would tell from this one: other names for it
};

struct Rejected {
  std::string effect;
  std::string why;
};

/// Errors that no model can go below, as mean absolute and root mean square ones [rad].
struct NoiseFloor {
  double mean_absolute_rad = 0.0, rms_rad = 0.0;
  bool from_repeats = false;
  std::string how;  ///< one line for people: from how many pairs of repeats, or how else it was estimated
};

/// A run to record next.
struct NextRun {
  std::string name;           ///< of the trajectory
  std::string shape;          ///< of the command, in words
  int times = 1;              ///< to be recorded; all of them to be fitted
  double kp = 1.0, kd = 0.0;  ///< what to tell the drive, as BenchRun's
  bench::JointLoad load;
  double load_mass_kg = 0.0, load_length_m = 0.0;  ///< as in runs.csv; 0 on a bench without loads
  std::vector<double> t_s, q_cmd_rad;
};

/// How surely two effects part once the runs are there.
struct ExpectedPair {
  std::string first, second;
  double deviations = 0.0;  ///< of their comparison on runs left out, which tells them apart from 2 on
};

/// A small campaign to record next, and what it is to tell apart.
struct NextExcitation {
  std::string text;  ///< one line for the engineer
  std::vector<std::string> tells_apart;
  std::vector<NextRun> runs;
  std::vector<ExpectedPair> pairs;
};

struct Diagnosis {
  evidence::Verdict verdict = evidence::Verdict::kNone;
  std::vector<Cause> causes;  ///< the strongest first
  std::vector<Rejected> rejected;
  NoiseFloor noise_floor;
  /// Mean absolute errors over the held-out runs with block-bootstrap intervals; over folds where nothing was held out.
  evidence::Interval held_out_before, held_out_after;
  bool held_out = false;               ///< runs were kept for the score; else the two above are from folds
  double share_of_way_to_floor = 0.0;  ///< (before - after) / (before - floor)
  /// What a usual block of half a second of the fitted runs misses by, in the noise (rms; geometric mean over blocks):
  /// 1 where only noise is left.
  double before_over_noise = 1.0, after_over_noise = 1.0;
  std::vector<std::string> depends_on;  ///< what a remaining residual hangs together with: velocity, position, ...
  std::optional<NextExcitation> next_excitation;
  std::string unit = "rad";
  calib::JointModel before, after;
  std::vector<std::string> base_parameters;  ///< fitted with and without effects
  std::vector<evidence::Option> options;     ///< that it was decided by
};

}  // namespace pmg::diagnosis
