// A bench: bench.yaml says what the rig and the drive are, runs.csv which recordings there are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/csv_table.hpp"
#include "bench/recording.hpp"
#include "bench/row_filter.hpp"
#include "model/actuator_parameters.hpp"
#include "work/progress.hpp"

namespace pmg::bench {

/// What the joint moves besides its own rotor. On a linear rig kg and N.
struct JointLoad {
  double inertia_kg_m2 = 0.0;  ///< about the axis
  double gravity_Nm = 0.0;     ///< torque on the joint is -gravity_Nm sin(q - hangs_at): hangs_at is down
  double hangs_at_rad = 0.0;   ///< 0 but for a robot's joints
};

enum class Rig { kPendulum, kHorizontal, kLinear, kRobot };
enum class DriveLaw { kServoVoltage, kPositionPd, kCascadePd, kTorque };

struct BenchLoad {
  double mass_kg = 0.0, length_m = 0.0;
  JointLoad load;  ///< a point mass's where bench.yaml says unknown
  bool inertia_known = false, gravity_known = false;
};

/// One row of runs.csv with its recording.
struct BenchRun {
  std::string file, trajectory;
  int repeat = 0;
  std::optional<double> temp_C;  ///< as runs.csv says
  double kp = 1.0, kd = 0.0;     ///< what the drive was told, in its own unit; 1 where runs.csv says nothing
  JointLoad load;
  Recording recording;
};

struct Bench {
  std::filesystem::path folder;
  std::string robot, joint;  ///< of a robot's rig; empty where bench.yaml doesn't say
  Rig rig = Rig::kPendulum;
  DriveLaw law = DriveLaw::kPositionPd;
  double sample_rate_hz = 100.0;
  bool linear_hold = false;  ///< commands run straight between samples instead of being held
  /// What bench.yaml knows of drive and rotor; the rest neutral.
  model::ActuatorParameters known;
  /// Names of known's parameters that bench.yaml leaves "unknown".
  std::vector<std::string> unknown;
  double kp_of_law = 1.0, kd_of_law = 0.0;  ///< of the cascade, where gains aren't a run's
  double supply_V = 1.0;                    ///< where no bus is recorded
  std::vector<BenchLoad> loads;
  CsvTable runs;

  /// The rows that the filter keeps, read and checked; those read so far where progress is over. Throws
  /// files::ConfigError, std::invalid_argument when none is.
  std::vector<BenchRun> read_runs(const RowFilter& filter, const work::Progress& progress = {}) const;
  /// What motor.yaml calls the joint unless told otherwise: bench.yaml's joint, or the folder's name.
  std::string joint_name() const;
};

/// Throws files::ConfigError on whatever is missing, unknown or implausible.
Bench read_bench(const std::filesystem::path& folder);

}  // namespace pmg::bench
