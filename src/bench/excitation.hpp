// What a joint is told so that its recording shows what drives and gears do (paper III-C.1: a mixture of steps and
// smooth segments), and the bench without recordings in which it is handed on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::bench {

struct ExcitationLimits {
  double lower_rad = -0.5, upper_rad = 0.5;
  double speed_rad_s = 3.0;  ///< of smooth segments; steps are as steep as the drive makes them
  double rate_hz = 100.0;    ///< of commands
  double seconds = 8.0;      ///< of one trajectory
};

struct ExcitationGains {
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
};

/// For one joint of a hanging robot: half of the way from the standing posture to the nearer end of the range, and no
/// more than half a radian (the others hold still, and a limb that swings far meets them); a third of the joint's
/// speed.
ExcitationLimits excitation_limits(const model::Joint& joint, const ExcitationLimits& rate_and_seconds = {});
/// The joint's own, half its kp, half of both: two kd tell Kd from damping.
std::vector<ExcitationGains> excitation_gains(const model::Joint& joint);

/// One command over time; begins and ends at rest at one angle, the same for all of an excitation.
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

  const ExcitationTrajectory& trajectory(const std::string& name) const;  ///< one of trajectories'
};

/// Five trajectories, each with every pair of gains, the whole so many times: `steps` of random heights and pauses;
/// `sines`, three at once; `sweep`, 0.2 to 8 Hz at the speed limit; `slow`, there and back at three creeping speeds;
/// `mixed`, steps and sines in turn. Two kd at least are wanted: of one, Kd and damping are the same number. Same
/// input and seed: same excitation. Throws std::invalid_argument on limits or gains that make no sense.
Excitation make_excitation(const ExcitationLimits& limits, const std::vector<ExcitationGains>& gains, int repeats,
                           unsigned seed);

/// Writes FOLDER/bench.yaml, runs.csv and commands/TRAJECTORY.csv (t_s, q_cmd_rad): a bench whose runs/ are still to be
/// recorded. design: the experiment in words. Throws std::runtime_error when a file can't be written, and when there is
/// a bench already.
void write_excitation(const std::filesystem::path& folder, const Excitation& excitation, const std::string& design);

/// Reads back runs.csv and commands/. Throws files::ConfigError on what is missing, unknown or not evenly timed.
Excitation read_excitation(const std::filesystem::path& folder);

/// model::files_sha256 of what read_excitation reads of this excitation's folder.
std::string excitation_sha256(const std::filesystem::path& folder, const Excitation& excitation);

}  // namespace pmg::bench
