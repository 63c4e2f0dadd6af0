#include "data_faults/row_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

constexpr double kMostSimilar = 0.6;

std::string condition_text(const bench::BenchRun& run) {
  return fmt::format("kp {:.4g}, kd {:.4g}, load {:.4g} kg m^2 and {:.4g} Nm", run.kp, run.kd, run.load.inertia_kg_m2,
                     run.load.gravity_Nm);
}

/// The run's row with gains and load of another one.
bench::Correction row_fix(const Examined& e, std::size_t run, std::size_t like) {
  bench::RowConditions conditions = conditions_of(e.runs()[like]);
  conditions.trajectory = e.runs()[run].trajectory;
  conditions.repeat = e.runs()[run].repeat;
  return {.files = {e.runs()[run].file}, .conditions = conditions};
}

/// A run whose gains and load are better those of another row.
struct Suspect {
  std::size_t run = 0, like = 0;  ///< like: a run with these gains and load
  double gain = 0.0, log_error = 0.0;
};

/// One run of each combination of gains and load.
std::vector<std::size_t> distinct_conditions(const Examined& e) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < e.runs().size(); ++i) {
    const bool seen = std::any_of(found.begin(), found.end(),
                                  [&](std::size_t other) { return same_condition(e.runs()[i], e.runs()[other]); });
    if (!seen) found.push_back(i);
  }
  return found;
}

/// Physics treats similar runs alike: what repeats show, too, or runs of the trajectory with the same load or the same
/// gains, is no fault of the row. Most of them must be far better, because one of them may have a fault of its own.
bool unlike_similar(const Examined& e, const Suspect& suspect) {
  const bench::BenchRun& one = e.runs()[suspect.run];
  const auto most_are_better = [&](const auto& similar_to) {
    std::size_t similar = 0, better = 0;
    for (std::size_t i = 0; i < e.runs().size(); ++i) {
      if (i == suspect.run || e.runs()[i].trajectory != one.trajectory || !similar_to(e.runs()[i])) continue;
      ++similar;
      if (e.log_error()[suspect.run] - e.log_error()[i] > 0.5 * suspect.gain) ++better;
    }
    return static_cast<double>(better) >= kMostSimilar * static_cast<double>(similar);
  };
  return most_are_better([&](const bench::BenchRun& other) { return other.load == one.load; }) &&
         most_are_better([&](const bench::BenchRun& other) { return other.kp == one.kp && other.kd == one.kd; });
}

/// The row that explains the run best.
Suspect best_row(const Examined& e, std::size_t run, const std::vector<std::size_t>& conditions) {
  Suspect best{.run = run, .gain = -std::numeric_limits<double>::infinity()};
  for (const std::size_t like : conditions) {
    if (same_condition(e.runs()[run], e.runs()[like])) continue;
    const double log = log_error_with(e, run, row_fix(e, run, like));
    if (const double gain = e.log_error()[run] - log; gain > best.gain) best = {run, like, gain, log};
  }
  return best;
}

std::vector<Suspect> suspects(const Examined& e) {
  const double middle = fitting::median(e.log_error());
  const std::vector<std::size_t> conditions = distinct_conditions(e);
  std::vector<Suspect> found;
  for (std::size_t run = 0; run < e.runs().size(); ++run) {
    if (e.log_error()[run] < middle) continue;  // no worse than the others
    const Suspect best = best_row(e, run, conditions);
    if (best.gain > std::log(e.options().pair_gain) && mends(e, run, e.log_error()[run], best.log_error) &&
        unlike_similar(e, best)) {
      found.push_back(best);
    }
  }
  return found;
}

/// The pair with its rows exchanged. A run's best row may be a similar one: the pair as a whole must explain most of
/// what the best rows of both explain.
Explained exchanged(const Examined& e, const Suspect& a, const Suspect& b) {
  constexpr double kOfBest = 0.8;
  const DataFaultOptions& o = e.options();
  const std::string &first = e.runs()[a.run].file, &second = e.runs()[b.run].file;
  const bench::Correction of_a = row_fix(e, a.run, b.run), of_b = row_fix(e, b.run, a.run);
  const double log_a = log_error_with(e, a.run, of_a), log_b = log_error_with(e, b.run, of_b);
  const double gain_a = e.log_error()[a.run] - log_a, gain_b = e.log_error()[b.run] - log_b;
  const bool sure = std::min(gain_a, gain_b) > std::log(o.pair_gain) && gain_a + gain_b > 2.0 * std::log(o.row_gain) &&
                    gain_a + gain_b > kOfBest * (a.gain + b.gain) && mends(e, a.run, e.log_error()[a.run], log_a) &&
                    mends(e, b.run, e.log_error()[b.run], log_b);
  DataFault fault = swapped_runs(e.runs()[a.run], e.runs()[b.run],
                                 {fmt::format("{}: {}", first, gain_text(e, e.log_error()[a.run], log_a)),
                                  fmt::format("{}: {}", second, gain_text(e, e.log_error()[b.run], log_b))});
  fault.fixes = {of_a, of_b};  // each keeps its trajectory, which its commands have told
  return {.fault = std::move(fault), .gain = gain_a + gain_b, .sure = sure};
}

Explained alone(const Examined& e, const Suspect& suspect) {
  const std::string &file = e.runs()[suspect.run].file, &like = e.runs()[suspect.like].file;
  const double before = e.log_error()[suspect.run];
  return {.fault = {.kind = Kind::kRow,
                    .where = fmt::format("runs.csv, row {}", file),
                    .correction = fmt::format("{} was recorded with {}, as {} was", file,
                                              condition_text(e.runs()[suspect.like]), like),
                    .evidence = {gain_text(e, before, suspect.log_error)},
                    .fixes = {row_fix(e, suspect.run, suspect.like)},
                    .files = {file}},
          .gain = suspect.gain,
          .sure = suspect.gain > std::log(e.options().clear_gain) && before > e.usual_log_error()};
}

}  // namespace

double lowest_log_error_of_rows(const Examined& e, std::size_t run) {
  return e.log_error()[run] - best_row(e, run, distinct_conditions(e)).gain;
}

std::vector<Explained> row_explanations(const Examined& e) {
  const std::vector<Suspect> suspected = suspects(e);
  std::vector<Explained> found;
  for (std::size_t a = 0; a < suspected.size(); ++a) {
    for (std::size_t b = a + 1; b < suspected.size(); ++b) {
      if (same_condition(e.runs()[suspected[a].run], e.runs()[suspected[b].run])) continue;
      found.push_back(exchanged(e, suspected[a], suspected[b]));
    }
  }
  for (const Suspect& suspect : suspected) found.push_back(alone(e, suspect));
  return found;
}

}  // namespace pmg::data_faults
