#include "data_faults/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data_faults/column_checks.hpp"
#include "data_faults/commanded_torque_check.hpp"
#include "data_faults/position_checks.hpp"
#include "data_faults/row_checks.hpp"
#include "data_faults/shift_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using bench::Column;

constexpr std::size_t kFewestRuns = 3;  // two runs that differ don't say which of them is wrong

/// The column of the positions that is at fault in one run. Another run of the trajectory had the same commands, if the
/// commands are right.
Column turned_column(const Examined& e, std::size_t run, double factor, bool& sure) {
  const bench::BenchRun& suspect = e.runs()[run];
  sure = true;
  for (std::size_t other = 0; other < e.runs().size(); ++other) {
    if (other == run || e.runs()[other].trajectory != suspect.trajectory) continue;
    if (same_commands(suspect, e.runs()[other], 1.0, e.options())) return Column::kPosition;
    if (same_commands(suspect, e.runs()[other], factor, e.options())) return Column::kPositionCommand;
  }
  const Alignment speed = speed_of_readings(e.bench(), suspect, e.options().longest_shift_s);
  if (speed.known && std::abs(speed.correlation) > e.options().sure_correlation) {
    return speed.factor * factor > 0.0 ? Column::kPosition : Column::kPositionCommand;
  }
  sure = false;
  return Column::kPosition;
}

/// One correction of the positions of one run, judged by the model. Weak drives hardly follow fast commands, so that
/// no correlation is asked for.
void try_position(const Examined& e, std::size_t run, Column column, const std::string& unit, double factor,
                  std::vector<Explained>& into) {
  const std::string file = e.runs()[run].file;
  bench::Correction fix{.files = {file}, .columns = {column}, .factor = factor};
  bool sure = true;
  if (unit.empty()) fix.columns = {turned_column(e, run, -1.0, sure)};
  // In another unit the readings are missed by another error: a share of their size counts.
  const double scale = column == Column::kPosition && !unit.empty() ? -std::log(factor) : 0.0;
  const double before = e.log_error()[run] - scale, after = log_error_with(e, run, fix);
  const std::string name = bench::column_name(fix.columns.front(), e.linear());
  DataFault fault{.kind = unit.empty() ? Kind::kSign : Kind::kUnit, .where = place_of(name, {file}), .correction = {}};
  if (!sure) fault.where += fmt::format(" (or {})", bench::column_name(Column::kPositionCommand, e.linear()));
  fault.correction = unit.empty() ? fmt::format("turn the sign of {} in {}", name, file)
                                  : fmt::format("{} of {} is in {}: multiply it by {:.6g}", name, file, unit, factor);
  const Follows by = follows(e, e.runs()[run]);
  fault.evidence = {
      fmt::format("readings move {:.3g} times as far as commands (correlation {:.2f})", by.slope, by.correlation),
      gain_text(e, before, after)};
  fault.fixes = {fix};
  fault.files = {file};
  into.push_back(
      {fault, before - after, before - after > std::log(e.options().clear_gain) && mends(e, run, before, after)});
}

/// Signs and units of the positions of one run.
void try_positions(const Examined& e, std::size_t run, std::vector<Explained>& into) {
  if (e.log_error()[run] < fitting::median(e.log_error())) return;  // no worse than the others
  const Follows by = follows(e, e.runs()[run]);
  // Where the torque is the command, readings and torque turned are the same joint; the planned motion tells them
  // apart.
  const bool torque_turned = e.bench().law == bench::DriveLaw::kTorque && by.known && !by.turned;
  if (!torque_turned) try_position(e, run, Column::kPosition, "", -1.0, into);
  for (const WrongUnit& unit : position_units(e.linear())) {
    try_position(e, run, Column::kPositionCommand, unit.name, 1.0 / unit.per_unit, into);
    if (by.known && by.unit == unit.name && by.column == Column::kPosition)
      try_position(e, run, Column::kPosition, unit.name, 1.0 / unit.per_unit, into);
  }
}

}  // namespace

std::vector<DataFault> clearest_position_fault(const Examined& e) {
  std::vector<Explained> all;
  for (std::size_t run = 0; run < e.runs().size(); ++run) try_positions(e, run, all);
  return clearest(all);
}

std::vector<DataFault> clearest_run_fault(const Examined& e) {
  if (e.runs().size() < kFewestRuns) return {};
  std::vector<Explained> all = row_explanations(e);
  try_shifts(e, all);
  for (std::size_t run = 0; run < e.runs().size(); ++run) try_commanded_torque(e, run, all);
  return clearest(all);
}

}  // namespace pmg::data_faults
