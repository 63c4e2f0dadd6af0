// Corrections of a bench's data: what a column or a row should have said.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/joint_load.hpp"
#include "bench/recording.hpp"

namespace pmg::bench {

struct Bench;
struct BenchRun;

enum class Column { kPositionCommand, kPosition, kSpeedCommand, kSpeed, kFeedForward, kTorque, kDriveVoltage, kBus };

/// Name of the column in a recording's file; on a linear rig with metres and newtons.
std::string column_name(Column column, bool linear);

/// The recording's values of this column; empty if the file lacks it.
std::vector<double>& values(Recording& recording, Column column);
const std::vector<double>& values(const Recording& recording, Column column);

/// (times, a column) => what the column has at t + shift_s, linear between samples; its first or last value beyond
/// them.
std::vector<double> shifted(const std::vector<double>& t_s, const std::vector<double>& values, double shift_s);

/// Gains and load as a row of runs.csv gives them.
struct RowConditions {
  std::string trajectory;
  int repeat = 0;
  double kp = 1.0, kd = 0.0;
  JointLoad load;
};

/// One correction of the runs that it names. Exactly one of its parts differs from the default.
struct Correction {
  std::vector<std::string> files{};  ///< of the runs; empty: all
  /// The right value of these columns at t is factor * (recorded value at t + shift_s). Where the recording has ended
  /// the value is unknown: such samples are cut off all columns.
  std::vector<Column> columns{};
  double factor = 1.0, shift_s = 0.0;
  double kp_factor = 1.0, kd_factor = 1.0;    ///< right gain over the row's
  double load_factor = 1.0;                   ///< right inertia and gravity over those of bench.yaml
  std::optional<RowConditions> conditions{};  ///< what the row should have said
  /// Samples whose reading isn't the joint's: they become invalid. The readings beside them are joined by lines, for
  /// whoever needs a number there.
  std::vector<std::size_t> unknown_readings{};
};

/// (run) => (run with the correction, if it is one of the named).
void correct(BenchRun& run, const Correction& correction);

/// The bench whose runs are read with these corrections, and without the runs in left_out.
Bench corrected(const Bench& bench, const std::vector<Correction>& corrections,
                const std::vector<std::string>& left_out);

}  // namespace pmg::bench
