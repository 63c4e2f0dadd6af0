// A bench: bench.yaml describes the rig and the drive, runs.csv lists the recordings.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/correction.hpp"
#include "bench/csv_table.hpp"
#include "bench/joint_load.hpp"
#include "bench/recording.hpp"
#include "bench/row_filter.hpp"
#include "model/actuator_parameters.hpp"
#include "work/progress.hpp"

namespace pmg::bench {

enum class Rig { kPendulum, kHorizontal, kLinear, kRobot };
enum class DriveLaw { kServoVoltage, kPositionPd, kCascadePd, kTorque };

struct BenchLoad {
  double mass_kg = 0.0, length_m = 0.0;
  JointLoad load;                                         ///< of a point mass where bench.yaml has no number
  bool inertia_unknown = false, gravity_unknown = false;  ///< bench.yaml says "unknown": a fit is to find it
};

/// A parameter that is larger in this run's assembly than in the model of all runs: of this arm, this servo.
struct AssemblyDifference {
  std::string parameter;                 ///< of model::actuator_parameters, or load.gravity_scale
  double amount = 0.0;                   ///< in the parameter's unit
  double lower = -1e300, upper = 1e300;  ///< range of the parameter: the sum is cut at it
};

/// One row of runs.csv with its recording.
struct BenchRun {
  std::string file, trajectory;
  int repeat = 0;
  double place = 1.0;            ///< among the recordings of runs.csv: near 0 the first, near 1 the last; 1 after all
  std::optional<double> temp_C;  ///< from runs.csv
  double kp = 1.0, kd = 0.0;     ///< commanded gains, in the drive's own unit; kp = 1 and kd = 0 without a column
  JointLoad load;
  std::vector<AssemblyDifference> differs{};  ///< nothing until somebody has found a difference
  Recording recording;
};

struct Bench {
  std::filesystem::path folder;
  std::string robot, joint;  ///< of a robot's rig; empty without an entry in bench.yaml
  Rig rig = Rig::kPendulum;
  DriveLaw law = DriveLaw::kPositionPd;
  double sample_rate_hz = 100.0;
  bool linear_hold = false;  ///< true: commands are interpolated linearly between samples; false: held
  /// Known parameters of drive and rotor; all others have no effect.
  model::ActuatorParameters known;
  /// Names of the parameters that bench.yaml calls "unknown".
  std::vector<std::string> unknown;
  double kp_of_law = 1.0, kd_of_law = 0.0;  ///< gains of a cascade, if runs.csv has no columns of gains
  double supply_V = 1.0;                    ///< supply voltage if no bus voltage is recorded
  std::optional<double> nominal_supply_V;   ///< as bench.yaml has it
  std::vector<BenchLoad> loads;
  CsvTable runs;
  std::vector<Correction> corrections;  ///< of what the files say; none of them until somebody asks for it
  std::vector<std::string> left_out;    ///< files of runs that are not read
  bool other_units = false;             ///< positions too large for their unit are read, too (RecordingFormat)

  /// (filter) => (its rows with their recordings, checked and corrected, without those left out). After an
  /// interruption: the rows read so far. Throws files::ConfigError; std::invalid_argument if the filter keeps no row.
  std::vector<BenchRun> read_runs(const RowFilter& filter, const work::Progress& progress = {}) const;
  /// (feed-forward torque, supply voltage or 1) => (what the drive adds to its output for it [unit of output]):
  /// torque / (torque_per_unit supply). NaN if bench.yaml doesn't know the drive's torque constant.
  double feed_forward_output(double torque_Nm, double supply) const;
  /// Default name of the joint in motor.yaml: the joint of bench.yaml, or the folder's name.
  std::string joint_name() const;
};

/// Throws files::ConfigError on a key or column that is missing, unknown or implausible.
Bench read_bench(const std::filesystem::path& folder);

}  // namespace pmg::bench
