#include "data_faults/shift_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/noise_floor.hpp"
#include "data_faults/column_checks.hpp"
#include "data_faults/commanded_torque_check.hpp"
#include "data_faults/row_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using bench::Column;

/// What the readings answer to.
std::string command_name(const Examined& e) {
  const bool torque = e.bench().law == bench::DriveLaw::kTorque;
  return bench::column_name(torque ? commanded_torque(e) : Column::kPositionCommand, e.linear());
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
  return std::max<double>(e.options().model_shift_samples * e.sample_s(), e.options().least_shift_s);
}

/// A shift that a sibling shows, too, is physics: fast motion lags, and a weak drive lags more. Of three repeats and
/// more with the same commands the repeats themselves have told (repeat_faults()), more finely than a model.
void try_shift(const Examined& e, std::size_t run, const std::vector<Shift>& shifts, std::vector<Explained>& into) {
  const std::vector<std::size_t> alike = siblings(e, run);
  const bool repeated = same_condition(e.runs()[alike.front()], e.runs()[run]);
  const auto compared = std::ranges::count_if(alike, [&](std::size_t other) {
    return repeated && e.runs()[other].trajectory == e.runs()[run].trajectory &&
           same_commands(e.runs()[other], e.runs()[run], 1.0, e.options());
  });
  if (compared > 1) return;
  double usual_s = 0.0, nearest_s = std::numeric_limits<double>::infinity();
  for (const std::size_t sibling : alike) {
    const double apart_s = std::abs(shifts[run].lag_s - shifts[sibling].lag_s);
    if (apart_s < nearest_s) nearest_s = apart_s, usual_s = shifts[sibling].lag_s;
  }
  const double lag_s = shifts[run].lag_s - usual_s, before = e.log_error()[run];
  if (std::abs(lag_s) < least_shift_s(e)) return;
  DataFault fault = shifted_readings(e, run, lag_s, {});
  const double after = log_error_with(e, run, fault.fixes.front());
  fault.evidence = {fmt::format("the readings of the most similar run lie {:.3g} s from the model's, these {:.3g} s",
                                usual_s, shifts[run].lag_s),
                    gain_text(e, before, after)};
  // Wrong gains or a wrong load make a run late or early, too: then another row explains it better than a shift.
  const double least = repeated ? e.options().shift_gain : e.options().lone_shift_gain;
  const bool sure =
      before - after > std::log(least) && mends(e, run, before, after) && after < lowest_log_error_of_rows(e, run);
  into.push_back({fault, before - after, sure});
}

/// A fit of all runs with readings moved to be so much later.
struct Moved {
  double by_s = 0.0;
  QuickFit fit;
};

Moved moved(const Examined& e, double by_s, const QuickFit& from) {
  const auto runs = e.with({{.files = {}, .columns = {Column::kPosition}, .shift_s = -by_s}});
  return {by_s, e.model().refit(e.few_of(runs), from, {})};
}

/// Early readings pull friction and inertia after them, so that the fitted model hides a part of a short time: it is
/// fitted again at each shift. The smallest shift that is not clearly worse than the best.
Moved short_shift(const Examined& e, const QuickFit& unmoved) {
  constexpr std::size_t kMost = 8;
  std::vector<Moved> all = {{0.0, unmoved}};
  while (all.size() <= kMost) {
    all.push_back(moved(e, static_cast<double>(all.size()) * e.sample_s(), all.back().fit));
    if (all.back().fit.loss_with_prior > all[all.size() - 2].fit.loss_with_prior) break;
  }
  const Moved best = *std::min_element(all.begin(), all.end(), [](const Moved& a, const Moved& b) {
    return a.fit.loss_with_prior < b.fit.loss_with_prior;
  });
  const auto found = std::find_if(all.begin(), all.end(), [&](const Moved& one) {
    return evidence(best.fit, one.fit) <= e.options().exact_evidence;
  });
  return found == all.end() ? all.front() : *found;
}

/// By how much all readings are early, where no effect of the catalogue explains them as well; else 0. plain: by the
/// fitted model, which misses them by lag_s; otherwise the shift has to leave nothing to explain.
double early_s(const Examined& e, double lag_s, bool plain) {
  const DataFaultOptions& o = e.options();
  const QuickFit unmoved = e.model().refit(e.few_of(e.runs()), e.fitted(), {});
  const Moved found = plain ? moved(e, -lag_s, unmoved) : short_shift(e, unmoved);
  if ((!plain && e.floors(found.fit) > o.exact_floors) || evidence(found.fit, unmoved) < o.exact_evidence) return 0.0;
  const QuickFit physics = e.model().with_best_effect(e.few_of(e.runs()), unmoved);
  return evidence(found.fit, physics) > o.exact_evidence ? found.by_s : 0.0;
}

}  // namespace

DataFault shifted_readings(const Examined& e, std::size_t run, double lag_s, std::vector<std::string> evidence) {
  const std::string file = e.runs()[run].file, column = bench::column_name(Column::kPosition, e.linear());
  return {.kind = Kind::kTimeShift,
          .where = place_of(column, {file}) + " against " + command_name(e),
          .correction = fmt::format("{} of {} is {:.3g} s {}: move it by {:.3g} s", column, file, std::abs(lag_s),
                                    lag_s > 0.0 ? "late" : "early", -lag_s),
          .evidence = std::move(evidence),
          .fixes = {{.files = {file}, .columns = {Column::kPosition}, .shift_s = lag_s}},
          .files = {file}};
}

void try_shifts(const Examined& e, std::vector<Explained>& into) {
  std::vector<Shift> shifts;
  for (std::size_t run = 0; run < e.runs().size(); ++run) shifts.push_back(best_shift(e, run));
  for (std::size_t run = 0; run < e.runs().size(); ++run) try_shift(e, run, shifts, into);
}

std::vector<DataFault> common_shift(const Examined& e) {
  std::vector<double> lags_s, gains;
  for (const std::size_t run : e.few()) {
    const Shift shift = best_shift(e, run);
    lags_s.push_back(shift.lag_s);
    gains.push_back(e.log_error()[run] - shift.log_error);
  }
  const double lag_s = fitting::median(lags_s), delay_s = e.fitted().model.actuator.command.delay_s;
  const bool plain = fitting::median(gains) > std::log(e.options().shift_gain);
  const bool late = plain && delay_s + lag_s > e.options().longest_delay_s;
  // A fit that misses more than repeats and took all delay away may hide readings that are early.
  const bool hidden = delay_s < 0.5 * e.sample_s() && e.floors(e.fitted()) > e.options().exact_floors;
  const bool early = lag_s < -0.5 * e.sample_s() || hidden;
  const double whole_s = late ? delay_s + lag_s : early ? -early_s(e, lag_s, plain && -lag_s > least_shift_s(e)) : 0.0;
  if (std::abs(whole_s) < least_shift_s(e)) return {};
  const std::string column = bench::column_name(Column::kPosition, e.linear());
  return {{.kind = Kind::kTimeShift,
           .where = fmt::format("{} against {}", place_of(column, {}), command_name(e)),
           .correction = fmt::format("{} is {:.3g} s {}: move it by {:.3g} s", column, std::abs(whole_s),
                                     whole_s < 0.0 ? "early" : "late", -whole_s),
           .evidence = {fmt::format(
               "readings move {:.3g} s {}", std::abs(whole_s),
               late ? "after their commands: more than a drive's delay" : "before their commands: no drive does that")},
           .fixes = {{.files = {}, .columns = {Column::kPosition}, .shift_s = whole_s}}}};
}

}  // namespace pmg::data_faults
