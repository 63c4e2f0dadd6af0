// Writes recordings of a robot's joint as a bench: bench.yaml, runs.csv, runs/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::bench {

/// One run. Columns have equal lengths; empty columns are not written.
struct WrittenRun {
  std::string file, trajectory;
  int repeat = 0;
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
  std::vector<double> t_s, q_cmd_rad, q_rad, dq_rad_s, torque_Nm, temp_C;
};

/// bench.yaml of a joint of a robot (rig `robot`, drive law `position_pd`).
struct RobotBench {
  std::string robot, joint, design;
  double sample_rate_hz = 100.0, effort_limit_Nm = 0.0;
  double load_mass_kg = 0.0;
  JointLoad load;
};

/// Writes bench.yaml last: a folder without it is no bench. Throws std::runtime_error if a file can't be written.
void write_bench(const std::filesystem::path& folder, const RobotBench& bench, const std::vector<WrittenRun>& runs);

}  // namespace pmg::bench
