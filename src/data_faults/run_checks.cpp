#include "data_faults/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "bench/noise_floor.hpp"
#include "data_faults/column_checks.hpp"
#include "data_faults/position_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using bench::Column;

/// One explanation of a run, and by how much it lowers ln of the run's error.
struct Explained {
  DataFault fault;
  double gain = 0.0;
  bool sure = false;
};

double log_error_with(const Examined& e, std::size_t run, const bench::Correction& fix) {
  bench::BenchRun corrected = e.runs()[run];
  bench::correct(corrected, fix);
  return e.model().log_error(e.model().joint(corrected), e.fitted().model);
}

std::string gain_text(double before, double after, const Examined& e) {
  const char* unit = e.linear() ? "m" : "rad";
  return fmt::format("the model that fits the other runs misses this one by {:.3g} {} as it is, by {:.3g} {} corrected",
                     std::exp(before), unit, std::exp(after), unit);
}

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

/// Signs and units of the positions of one run.
void try_positions(const Examined& e, std::size_t run, std::vector<Explained>& into) {
  const Follows by = follows(e, e.runs()[run]);
  if (!by.known || (!by.turned && by.unit.empty())) return;
  const std::string file = e.runs()[run].file;
  bench::Correction fix{.files = {file}, .columns = {by.column}, .factor = (by.turned ? -1.0 : 1.0) / by.per_unit};
  bool told = true;
  if (by.unit.empty()) fix.columns = {turned_column(e, run, -1.0, told)};
  // In another unit the readings are missed by another error: a share of their size counts.
  const double scale = by.column == Column::kPosition && !by.unit.empty() ? std::log(by.per_unit) : 0.0;
  const double before = e.log_error()[run] - scale, after = log_error_with(e, run, fix);
  const std::string column = bench::column_name(fix.columns.front(), e.linear());
  DataFault fault{.kind = by.unit.empty() ? Kind::kSign : Kind::kUnit, .where = place_of(column, {file}), .correction = {}};
  if (!told) fault.where += fmt::format(" (or {})", bench::column_name(Column::kPositionCommand, e.linear()));
  fault.correction = by.unit.empty() ? fmt::format("turn the sign of {} in {}", column, file)
                                     : fmt::format("{} of {} is in {}: multiply it by {:.6g}", column, file, by.unit, fix.factor);
  fault.evidence = {fmt::format("readings move {:.3g} times as far as commands", by.slope), gain_text(before, after, e)};
  fault.fixes = {fix};
  fault.files = {file};
  into.push_back({fault, before - after,
                  before - after > std::log(e.options().clear_gain) && after < e.usual_log_error()});
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
      if (!r.valid[there]) continue;
      squares += std::pow(simulated[static_cast<std::size_t>(k)] - r.q_rad[there], 2);
      n += 1.0;
    }
    const double log = 0.5 * std::log(squares / std::max(1.0, n) + noise);
    if (n > 0.5 * static_cast<double>(count) && log < best.log_error) best = {static_cast<double>(lag) * e.sample_s(), log};
  }
  return best;
}

double least_shift_s(const Examined& e) {
  return std::max(e.options().shift_samples * e.sample_s(), e.options().least_shift_s);
}

bool same_condition(const bench::BenchRun& a, const bench::BenchRun& b) {
  return a.kp == b.kp && a.kd == b.kd && a.load == b.load;
}

/// Runs that physics treats like this one: its repeats; without repeats, the runs of its trajectory; else all others.
std::vector<std::size_t> siblings(const Examined& e, std::size_t run) {
  const bench::BenchRun& one = e.runs()[run];
  std::vector<std::size_t> repeats, trajectory, others;
  for (std::size_t i = 0; i < e.runs().size(); ++i) {
    if (i == run) continue;
    others.push_back(i);
    if (e.runs()[i].trajectory != one.trajectory) continue;
    trajectory.push_back(i);
    if (same_condition(e.runs()[i], one)) repeats.push_back(i);
  }
  return !repeats.empty() ? repeats : !trajectory.empty() ? trajectory : others;
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
  fault.evidence = {fmt::format("the readings of the most similar run lie {:.3g} s from the model's, these {:.3g} s", usual_s,
                                shifts[run].lag_s),
                    gain_text(before, after, e)};
  fault.fixes = {fix};
  fault.files = {file};
  into.push_back({fault, before - after,
                  before - after > std::log(e.options().shift_gain) && after < e.usual_log_error()});
}

std::string condition_text(const bench::BenchRun& run) {
  return fmt::format("kp {:.4g}, kd {:.4g}, load {:.4g} kg m^2 and {:.4g} Nm", run.kp, run.kd, run.load.inertia_kg_m2,
                     run.load.gravity_Nm);
}

/// Gains and load of another row.
struct OtherRow {
  std::size_t like = 0;  ///< a run with these gains and load
  double gain = 0.0, log_error = 0.0;
  bool any = false;
};

OtherRow best_row(const Examined& e, std::size_t run) {
  std::vector<std::size_t> distinct;
  for (std::size_t i = 0; i < e.runs().size(); ++i) {
    const bool seen = std::any_of(distinct.begin(), distinct.end(),
                                  [&](std::size_t other) { return same_condition(e.runs()[i], e.runs()[other]); });
    if (!seen) distinct.push_back(i);
  }
  OtherRow best;
  for (const std::size_t other : distinct) {
    if (same_condition(e.runs()[run], e.runs()[other])) continue;
    bench::RowConditions conditions = conditions_of(e.runs()[other]);
    const double log = log_error_with(e, run, {.files = {}, .columns = {}, .conditions = conditions});
    if (best.any && log >= best.log_error) continue;
    best = {other, e.log_error()[run] - log, log, true};
  }
  return best;
}

bench::Correction row_fix(const Examined& e, std::size_t run, std::size_t like) {
  bench::RowConditions conditions = conditions_of(e.runs()[like]);
  conditions.trajectory = e.runs()[run].trajectory;
  conditions.repeat = e.runs()[run].repeat;
  return {.files = {e.runs()[run].file}, .columns = {}, .conditions = conditions};
}

Explained swapped_rows(const Examined& e, std::size_t a, std::size_t b, const OtherRow& of_a, const OtherRow& of_b) {
  const std::string &first = e.runs()[a].file, &second = e.runs()[b].file;
  return {.fault = {.kind = Kind::kSwappedRuns,
                    .where = fmt::format("runs.csv, rows {} and {}", first, second),
                    .correction = fmt::format("exchange the files {} and {} in runs.csv", first, second),
                    .evidence = {fmt::format("{}: {}", first, gain_text(e.log_error()[a], of_a.log_error, e)),
                                 fmt::format("{}: {}", second, gain_text(e.log_error()[b], of_b.log_error, e))},
                    .fixes = {row_fix(e, a, b), row_fix(e, b, a)},
                    .files = {first, second}},
          .gain = of_a.gain + of_b.gain,
          .sure = true};
}

/// Rows of runs.csv with the gains and load of other rows.
void try_rows(const Examined& e, std::vector<Explained>& into) {
  const DataFaultOptions& o = e.options();
  const double usual = e.usual_log_error(), middle = fitting::median(e.log_error());
  struct Suspect {
    std::size_t run;
    OtherRow row;
  };
  std::vector<Suspect> suspects;
  for (std::size_t run = 0; run < e.runs().size(); ++run) {
    if (e.log_error()[run] < middle) continue;  // no worse than the others
    const OtherRow row = best_row(e, run);
    const std::vector<std::size_t> like = siblings(e, run);
    const bool unlike = std::all_of(like.begin(), like.end(), [&](std::size_t sibling) {
      return !same_condition(e.runs()[sibling], e.runs()[run]) ||
             e.log_error()[run] - e.log_error()[sibling] > 0.5 * row.gain;
    });
    if (row.any && unlike && row.gain > std::log(o.pair_gain) && row.log_error < usual) suspects.push_back({run, row});
  }
  for (const Suspect& a : suspects) {
    for (const Suspect& b : suspects) {
      if (b.run <= a.run || !same_condition(e.runs()[a.row.like], e.runs()[b.run]) ||
          !same_condition(e.runs()[b.row.like], e.runs()[a.run])) {
        continue;
      }
      if (a.row.gain + b.row.gain < 2.0 * std::log(o.row_gain)) continue;
      into.push_back(swapped_rows(e, a.run, b.run, a.row, b.row));
    }
    if (a.row.gain < std::log(o.clear_gain) || e.log_error()[a.run] < usual) continue;
    const std::string file = e.runs()[a.run].file;
    into.push_back({.fault = {.kind = Kind::kRow,
                              .where = fmt::format("runs.csv, row {}", file),
                              .correction = fmt::format("{} was recorded with {}, as {} was", file,
                                                        condition_text(e.runs()[a.row.like]), e.runs()[a.row.like].file),
                              .evidence = {gain_text(e.log_error()[a.run], a.row.log_error, e)},
                              .fixes = {row_fix(e, a.run, a.row.like)},
                              .files = {file}},
                    .gain = a.row.gain,
                    .sure = true});
  }
}

}  // namespace

std::vector<DataFault> clearest_run_fault(const Examined& e) {
  std::vector<Explained> all;
  std::vector<Shift> shifts;
  for (std::size_t run = 0; run < e.runs().size(); ++run) shifts.push_back(best_shift(e, run));
  for (std::size_t run = 0; run < e.runs().size(); ++run) {
    try_positions(e, run, all);
    if (e.runs().size() > 2) try_shift(e, run, shifts, all);
  }
  if (e.runs().size() > 2) try_rows(e, all);
  const Explained* best = nullptr;
  for (const Explained& one : all) {
    if (one.sure && (best == nullptr || one.gain > best->gain)) best = &one;
  }
  if (best == nullptr) return {};
  return {best->fault};
}

std::vector<DataFault> common_shift(const Examined& e) {
  std::vector<double> lags_s, gains;
  for (const std::size_t run : e.few()) {
    const Shift shift = best_shift(e, run);
    lags_s.push_back(shift.lag_s);
    gains.push_back(e.log_error()[run] - shift.log_error);
  }
  const double lag_s = fitting::median(lags_s), delay_s = e.fitted().model.actuator.command.delay_s;
  const bool early = lag_s < -least_shift_s(e), late = delay_s + lag_s > e.options().longest_delay_s;
  if ((!early && !late) || fitting::median(gains) < std::log(e.options().shift_gain)) return {};
  const double whole_s = early ? lag_s : delay_s + lag_s;
  const std::string column = bench::column_name(Column::kPosition, e.linear());
  const std::string command = bench::column_name(Column::kPositionCommand, e.linear());
  return {{.kind = Kind::kTimeShift,
           .where = fmt::format("{} against {}", place_of(column, {}), command),
           .correction = fmt::format("{} is {:.3g} s {}: move it by {:.3g} s", column, std::abs(whole_s),
                                     early ? "early" : "late", -whole_s),
           .evidence = {early ? fmt::format("readings move {:.3g} s before their commands: no drive does that", -lag_s)
                              : fmt::format("readings move {:.3g} s after their commands: more than a drive's delay", whole_s)},
           .fixes = {{.files = {}, .columns = {Column::kPosition}, .shift_s = whole_s}}}};
}

}  // namespace pmg::data_faults
