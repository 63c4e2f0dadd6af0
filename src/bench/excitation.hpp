// Excitations: commands to a joint whose response identifies drive and gear (paper III-C.1: a mixture of steps and
// smooth segments). They are stored as a bench without recordings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::bench {

struct ExcitationLimits {
  double lower_rad = -0.5, upper_rad = 0.5;
  double speed_rad_s = 3.0;  ///< of smooth segments; steps have no limit
  double rate_hz = 100.0;    ///< of commands
  double seconds = 8.0;      ///< of one trajectory
};

struct ExcitationGains {
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
};

/// Limits for one joint of a hanging robot. Amplitude: half of the distance from the standing posture to the nearer end
/// of the range, at most 0.5 rad: all other joints hold still, and a limb that swings further may hit one. Speed: a
/// third of the joint's limit.
ExcitationLimits excitation_limits(const model::Joint& joint, const ExcitationLimits& rate_and_seconds = {});
/// Three pairs of gains: the joint's own; half of its kp; half of both. Two values of kd separate Kd from damping.
std::vector<ExcitationGains> excitation_gains(const model::Joint& joint);

/// One command over time. All trajectories of an excitation begin and end at rest at the same angle.
struct ExcitationTrajectory {
  std::string name;
  std::vector<double> q_cmd_rad;
};

/// One recording to be made.
struct ExcitationRow {
  std::string file, trajectory;
  int repeat = 0;
  ExcitationGains gains;
};

struct Excitation {
  double rate_hz = 100.0;
  std::vector<ExcitationTrajectory> trajectories;
  std::vector<ExcitationRow> rows;  ///< in the order in which they are played

  const ExcitationTrajectory& trajectory(const std::string& name) const;  ///< by its name
};

/// Five trajectories, each with every pair of gains, `repeats` times: `steps` of random heights and pauses; `sines`,
/// the sum of three; `sweep`, 0.2 to 8 Hz at the speed limit; `slow`, strokes at three low speeds; `mixed`, steps and
/// sines in turn. Gains should have at least two values of kd: with a single kd, Kd and damping cannot be separated.
/// The same input and seed give the same excitation. Throws std::invalid_argument on invalid limits or gains.
Excitation make_excitation(const ExcitationLimits& limits, const std::vector<ExcitationGains>& gains, int repeats,
                           unsigned seed);

/// Writes FOLDER/bench.yaml, runs.csv and commands/TRAJECTORY.csv (t_s, q_cmd_rad): a bench whose runs/ are not yet
/// recorded. design: description of the experiment. Throws std::runtime_error if a file can't be written or the folder
/// already contains a bench.
void write_excitation(const std::filesystem::path& folder, const Excitation& excitation, const std::string& design);

/// Reads runs.csv and commands/. Throws files::ConfigError on a missing or unknown entry, and on uneven times.
Excitation read_excitation(const std::filesystem::path& folder);

/// model::files_sha256 of the files that read_excitation reads.
std::string excitation_sha256(const std::filesystem::path& folder, const Excitation& excitation);

}  // namespace pmg::bench
