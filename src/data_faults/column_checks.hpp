// Checks of columns against each other that need no model of the joint.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "data_faults/alignment.hpp"
#include "data_faults/data_fault.hpp"
#include "data_faults/options.hpp"

namespace pmg::data_faults {

/// A unit that people write into a column by mistake: value in it = per_unit * value in SI.
struct WrongUnit {
  std::string name;
  double per_unit = 1.0;
};

/// Of positions (and, per second, of speeds) on this rig.
std::vector<WrongUnit> position_units(bool linear);

/// The unit nearest to a measured factor, within options.unit_tolerance; empty name if there is none.
WrongUnit unit_of_factor(double factor, const std::vector<WrongUnit>& units, double tolerance);

/// "column q_rad of all runs", "column q_rad of run03.csv".
std::string place_of(const std::string& column, const std::vector<std::string>& files);

/// The recorded bus voltage in another unit, as some servos send it: beside bench.yaml's nominal one, else beside the
/// other runs.
std::vector<DataFault> supply_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                     const DataFaultOptions& options);

/// How a run's readings follow its commands, while the drive is on. The lag is at most longest_s.
Alignment following(const bench::Bench& bench, const bench::BenchRun& run, double longest_s);

/// How the recorded speed follows the derivative of the readings; unknown without such a column.
Alignment speed_of_readings(const bench::Bench& bench, const bench::BenchRun& run, double longest_s);

/// Of dq_cmd, which follows from q_cmd.
std::vector<DataFault> speed_command_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                            const DataFaultOptions& options);

/// Of all columns that follow from other columns: dq_cmd from q_cmd; dq from q; a recorded torque or voltage from the
/// drive's law, whose commands act `model_delay_s` late by the readings.
std::vector<DataFault> derived_column_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                             const DataFaultOptions& options, double model_delay_s);

}  // namespace pmg::data_faults
