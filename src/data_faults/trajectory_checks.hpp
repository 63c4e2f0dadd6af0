// Commands of runs against those of other runs with the same trajectory.
#pragma once

#include <vector>

#include "bench/bench.hpp"
#include "data_faults/data_fault.hpp"
#include "data_faults/options.hpp"

namespace pmg::data_faults {

/// True if both runs have the same commands, those of a multiplied by factor.
bool same_commands(const bench::BenchRun& a, const bench::BenchRun& b, double factor, const DataFaultOptions& options);

/// Gains, load and names of a run's row.
bench::RowConditions conditions_of(const bench::BenchRun& run);

/// Two rows of runs.csv that stand for each other, trajectory and repeat among the rest.
DataFault swapped_runs(const bench::BenchRun& one, const bench::BenchRun& other, std::vector<std::string> evidence);

/// Rows of runs.csv whose recording has the commands of another trajectory, where the recordings of every trajectory
/// agree otherwise: two rows that stand for each other, or one row.
std::vector<DataFault> trajectory_faults(const std::vector<bench::BenchRun>& runs, const DataFaultOptions& options);

}  // namespace pmg::data_faults
