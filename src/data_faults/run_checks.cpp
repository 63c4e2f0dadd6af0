#include "data_faults/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/noise_floor.hpp"
#include "data_faults/column_checks.hpp"
#include "data_faults/position_checks.hpp"
#include "data_faults/row_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using bench::Column;

constexpr std::size_t kFewestRuns = 3;  // two runs that differ don't say which of them is wrong

/// The column of the positions that is at fault in one run. Another run of the trajectory had the same commands, if the
/// commands are right.
Column turned_column(const Examined& e, std::size_t run, double factor, bool& told) {
  const bench::BenchRun& suspect = e.runs()[run];
  told = true;
  for (std::size_t other = 0; other < e.runs().size(); ++other) {
    if (other == run || e.runs()[other].trajectory != suspect.trajectory) continue;
    if (same_commands(suspect, e.runs()[other], 1.0, e.options())) return Column::kPosition;
    if (same_commands(suspect, e.runs()[other], factor, e.options())) return Column::kPositionCommand;
  }
  const Alignment speed = speed_of_readings(e.bench(), suspect, e.options().longest_shift_s);
  if (speed.known && std::abs(speed.correlation) > e.options().sure_correlation) {
    return speed.factor * factor > 0.0 ? Column::kPosition : Column::kPositionCommand;
  }
  told = false;
  return Column::kPosition;
}

/// One correction of the positions of one run, judged by the model. Weak drives hardly follow fast commands, so that
/// no correlation is asked for.
void try_position(const Examined& e, std::size_t run, Column column, const std::string& unit, double factor,
                  std::vector<Explained>& into) {
  const std::string file = e.runs()[run].file;
  bench::Correction fix{.files = {file}, .columns = {column}, .factor = factor};
  bool told = true;
  if (unit.empty()) fix.columns = {turned_column(e, run, -1.0, told)};
  // In another unit the readings are missed by another error: a share of their size counts.
  const double scale = column == Column::kPosition && !unit.empty() ? -std::log(factor) : 0.0;
  const double before = e.log_error()[run] - scale, after = log_error_with(e, run, fix);
  const std::string name = bench::column_name(fix.columns.front(), e.linear());
  DataFault fault{.kind = unit.empty() ? Kind::kSign : Kind::kUnit, .where = place_of(name, {file}), .correction = {}};
  if (!told) fault.where += fmt::format(" (or {})", bench::column_name(Column::kPositionCommand, e.linear()));
  fault.correction = unit.empty() ? fmt::format("turn the sign of {} in {}", name, file)
                                  : fmt::format("{} of {} is in {}: multiply it by {:.6g}", name, file, unit, factor);
  const Follows by = follows(e, e.runs()[run]);
  fault.evidence = {
      fmt::format("readings move {:.3g} times as far as commands (correlation {:.2f})", by.slope, by.correlation),
      gain_text(e, before, after)};
  fault.fixes = {fix};
  fault.files = {file};
  into.push_back({fault, before - after, before - after > std::log(e.options().clear_gain) && mends(e, before, after)});
}

/// Signs and units of the positions of one run.
void try_positions(const Examined& e, std::size_t run, std::vector<Explained>& into) {
  if (e.log_error()[run] < fitting::median(e.log_error())) return;  // no worse than the others
  const Follows by = follows(e, e.runs()[run]);
  try_position(e, run, Column::kPosition, "", -1.0, into);
  for (const WrongUnit& unit : position_units(e.linear())) {
    try_position(e, run, Column::kPositionCommand, unit.name, 1.0 / unit.per_unit, into);
    if (by.known && by.unit == unit.name && by.column == Column::kPosition)
      try_position(e, run, Column::kPosition, unit.name, 1.0 / unit.per_unit, into);
  }
}

/// The sign of one run's feed-forward.
void try_feed_forward(const Examined& e, std::size_t run, std::vector<Explained>& into) {
  const std::vector<double>& tau = e.runs()[run].recording.tau_ff_Nm;
  if (std::all_of(tau.begin(), tau.end(), [](double value) { return value == 0.0; })) return;
  const std::string file = e.runs()[run].file;
  const bench::Correction fix{.files = {file}, .columns = {Column::kFeedForward}, .factor = -1.0};
  const double before = e.log_error()[run], after = log_error_with(e, run, fix);
  const std::string column = bench::column_name(Column::kFeedForward, e.linear());
  const DataFault fault{.kind = Kind::kSign,
                        .where = place_of(column, {file}),
                        .correction = fmt::format("turn the sign of {} in {}", column, file),
                        .evidence = {gain_text(e, before, after)},
                        .fixes = {fix},
                        .files = {file}};
  into.push_back({fault, before - after, before - after > std::log(e.options().clear_gain) && mends(e, before, after)});
}

/// Lag of the readings behind the model [s], and ln of the error there.
struct Shift {
  double lag_s = 0.0, log_error = 0.0;
};

Shift best_shift(const Examined& e, std::size_t run) {
  const bench::Recording& r = e.runs()[run].recording;
  const std::vector<double> simulated = e.model().joint(e.runs()[run]).rollout(e.fitted().model);
  const double noise = std::pow(bench::sensor_noise_rad(r), 2);
  const long longest = std::lround(e.options().longest_shift_s / e.sample_s());
  const long step = std::max(1L, std::lround(0.004 / e.sample_s()));
  const long count = static_cast<long>(simulated.size());
  Shift best{0.0, std::numeric_limits<double>::infinity()};
  for (long lag = -longest / step * step; lag <= longest; lag += step) {
    double squares = 0.0, n = 0.0;
    for (long k = std::max(0L, -lag); k < std::min(count, count - lag); ++k) {
      const auto there = static_cast<std::size_t>(k + lag);
      if (!r.valid[there] || (!r.enabled.empty() && !r.enabled[there])) continue;
      squares += std::pow(simulated[static_cast<std::size_t>(k)] - r.q_rad[there], 2);
      n += 1.0;
    }
    const double log = 0.5 * std::log(squares / std::max(1.0, n) + noise);
    if (n > 0.3 * static_cast<double>(count) && log < best.log_error)
      best = {static_cast<double>(lag) * e.sample_s(), log};
  }
  return best;
}

double least_shift_s(const Examined& e) {
  return std::max(e.options().shift_samples * e.sample_s(), e.options().least_shift_s);
}

/// A shift that a sibling shows, too, is physics: fast motion lags, and a weak drive lags more.
void try_shift(const Examined& e, std::size_t run, const std::vector<Shift>& shifts, std::vector<Explained>& into) {
  double usual_s = 0.0, nearest_s = std::numeric_limits<double>::infinity();
  for (const std::size_t sibling : siblings(e, run)) {
    const double apart_s = std::abs(shifts[run].lag_s - shifts[sibling].lag_s);
    if (apart_s < nearest_s) nearest_s = apart_s, usual_s = shifts[sibling].lag_s;
  }
  const double lag_s = shifts[run].lag_s - usual_s, before = e.log_error()[run];
  if (std::abs(lag_s) < least_shift_s(e)) return;
  const std::string file = e.runs()[run].file;
  const bench::Correction fix{.files = {file}, .columns = {Column::kPosition}, .shift_s = lag_s};
  const double after = log_error_with(e, run, fix);
  const std::string column = bench::column_name(Column::kPosition, e.linear());
  DataFault fault{.kind = Kind::kTimeShift, .where = {}, .correction = {}};
  fault.where = place_of(column, {file}) + " against " + bench::column_name(Column::kPositionCommand, e.linear());
  fault.correction = fmt::format("{} of {} is {:.3g} s {}: move it by {:.3g} s", column, file, std::abs(lag_s),
                                 lag_s > 0.0 ? "late" : "early", -lag_s);
  fault.evidence = {fmt::format("the readings of the most similar run lie {:.3g} s from the model's, these {:.3g} s",
                                usual_s, shifts[run].lag_s),
                    gain_text(e, before, after)};
  fault.fixes = {fix};
  fault.files = {file};
  // Wrong gains or a wrong load make a run late or early, too: then another row explains it better than a shift.
  const bool repeated = same_condition(e.runs()[siblings(e, run).front()], e.runs()[run]);
  const double least = repeated ? e.options().shift_gain : e.options().lone_shift_gain;
  const bool sure =
      before - after > std::log(least) && mends(e, before, after) && after < lowest_log_error_of_rows(e, run);
  into.push_back({fault, before - after, sure});
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
  std::vector<Shift> shifts;
  for (std::size_t run = 0; run < e.runs().size(); ++run) shifts.push_back(best_shift(e, run));
  for (std::size_t run = 0; run < e.runs().size(); ++run) {
    try_shift(e, run, shifts, all);
    try_feed_forward(e, run, all);
  }
  return clearest(all);
}

std::vector<DataFault> common_shift(const Examined& e) {
  std::vector<double> lags_s, gains;
  for (const std::size_t run : e.few()) {
    const Shift shift = best_shift(e, run);
    lags_s.push_back(shift.lag_s);
    gains.push_back(e.log_error()[run] - shift.log_error);
  }
  const double lag_s = fitting::median(lags_s), delay_s = e.fitted().model.actuator.command.delay_s;
  const bool early = lag_s<-least_shift_s(e), late = delay_s + lag_s> e.options().longest_delay_s;
  if ((!early && !late) || fitting::median(gains) < std::log(e.options().shift_gain)) return {};
  const double whole_s = early ? lag_s : delay_s + lag_s;
  const std::string column = bench::column_name(Column::kPosition, e.linear());
  const std::string command = bench::column_name(Column::kPositionCommand, e.linear());
  return {{.kind = Kind::kTimeShift,
           .where = fmt::format("{} against {}", place_of(column, {}), command),
           .correction = fmt::format("{} is {:.3g} s {}: move it by {:.3g} s", column, std::abs(whole_s),
                                     early ? "early" : "late", -whole_s),
           .evidence = {early ? fmt::format("readings move {:.3g} s before their commands: no drive does that", -lag_s)
                              : fmt::format("readings move {:.3g} s after their commands: more than a drive's delay",
                                            whole_s)},
           .fixes = {{.files = {}, .columns = {Column::kPosition}, .shift_s = whole_s}}}};
}

}  // namespace pmg::data_faults
