// Which columns of runs.csv may say what differs from assembly to assembly, and which runs are of one assembly.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::assembly {

/// A grouping of the runs by one column of runs.csv, or by columns that change together on these runs.
struct Grouping {
  std::vector<std::string> columns;  ///< more than one: these runs can't tell which of them it is
  std::vector<std::string> from;     ///< columns of runs.csv whose cells name a run's level
  std::vector<std::string> levels;   ///< its values with two runs or more
  std::vector<int> level_of_run;     ///< -1: a value with a single run, of which nothing can be said
  /// True if each load has one level: then physics that depends on the load may look like a difference of assemblies.
  bool follows_load = false;

  std::size_t runs_of(int level) const;
  bool operator==(const Grouping&) const = default;
};

/// (bench, run, columns) => (the run's cells in these columns: "b", or "0.5, 0.1"); "" if runs.csv doesn't list the
/// run.
std::string level_name(const bench::Bench& bench, const bench::BenchRun& run, const std::vector<std::string>& columns);

/// A column of which no grouping is made.
struct UnusedColumn {
  std::string column, why;
  bool operator==(const UnusedColumn&) const = default;
};

struct Groupings {
  std::vector<Grouping> usable;
  std::vector<UnusedColumn> unused;
};

/// (bench, runs, smallest number of runs of a level, largest number of levels) => (groupings). Not usable is
/// - what names the run or is set by the software or measured: file, trajectory, repeat, gains, temperature;
/// - a column with the same value in all runs, or with fewer than two values that have enough runs;
/// - a column that follows the trajectory or the gains: each of them has one value of the column. Nothing then tells
///   the assembly from what the software did.
/// Columns that part the runs alike are one grouping. Where several columns follow the load and none parts the loads
/// whole (mass and length), all of them together are one more grouping.
Groupings groupings(const bench::Bench& bench, const std::vector<const bench::BenchRun*>& runs, std::size_t fewest_runs,
                    std::size_t most_levels);

}  // namespace pmg::assembly
