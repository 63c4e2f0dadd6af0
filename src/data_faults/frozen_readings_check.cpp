#include "data_faults/frozen_readings_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "data_faults/column_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

constexpr std::size_t kFewestRepeats = 2;  // one repeat may be a clock that reads twice within a sample
constexpr std::size_t kBeside = 4;         // one-sample steps on each side that show the joint's motion
constexpr double kSteady = 0.3;            // of the largest step; constant deceleration to rest has less than 1/4
constexpr double kNatural_quanta = 2.0;    // a coarse sensor shows one step at a time
constexpr double kLongest = 1.5;           // times the longest clear stretch: a longer one is rest

/// A run's valid readings, one after the other.
struct Readings {
  std::vector<std::size_t> sample;
  std::vector<double> t_s, q_rad;
  double quantum_rad = 0.0, usual_step_rad = 0.0;  ///< smallest and median step that isn't 0
};

Readings readings_of(const bench::Recording& r) {
  Readings found;
  for (std::size_t k = 0; k < r.q_rad.size(); ++k) {
    if (!r.valid[k]) continue;
    found.sample.push_back(k);
    found.t_s.push_back(r.t_s[k]);
    found.q_rad.push_back(r.q_rad[k]);
  }
  std::vector<double> steps_rad;
  for (std::size_t k = 1; k < found.q_rad.size(); ++k) {
    if (found.q_rad[k] != found.q_rad[k - 1]) steps_rad.push_back(std::abs(found.q_rad[k] - found.q_rad[k - 1]));
  }
  if (steps_rad.empty()) return found;
  found.quantum_rad = *std::ranges::min_element(steps_rad);
  found.usual_step_rad = fitting::median(std::move(steps_rad));
  return found;
}

/// The readings from first to last are the same; the one after them is another one, or the run ends.
struct Stretch {
  std::size_t first = 0, last = 0;
  bool jumps = false;  ///< afterwards, as no step beside it does
  bool clear = false;  ///< and the joint moves steadily before and after: it moved meanwhile
};

double jump_rad(const Readings& r, const Stretch& s) {
  return s.last + 1 < r.q_rad.size() ? r.q_rad[s.last + 1] - r.q_rad[s.last] : 0.0;
}

double duration_s(const Readings& r, const Stretch& s) {
  return r.t_s[std::min(s.last + 1, r.t_s.size() - 1)] - r.t_s[s.first];
}

/// Mean speed from one reading to another, [rad/s].
double speed_rad_s(const Readings& r, std::size_t from, std::size_t to) {
  return to > from ? (r.q_rad[to] - r.q_rad[from]) / (r.t_s[to] - r.t_s[from]) : 0.0;
}

/// Speeds before and after the stretch, over up to kBeside steps.
std::pair<double, double> speeds_beside_rad_s(const Readings& r, const Stretch& s) {
  const std::size_t end = r.q_rad.size() - 1, begins = std::min(s.last + 1, end);
  return {speed_rad_s(r, s.first - std::min(s.first, kBeside), s.first),
          speed_rad_s(r, begins, std::min(begins + kBeside, end))};
}

/// Steps of one sample before and after the stretch, up to kBeside each.
struct Beside {
  std::vector<double> before_rad, after_rad;
};

Beside steps_beside(const Readings& r, const Stretch& s) {
  Beside found;
  for (std::size_t k = s.first - std::min(s.first, kBeside); k < s.first; ++k)
    found.before_rad.push_back(r.q_rad[k + 1] - r.q_rad[k]);
  for (std::size_t k = s.last + 1; k < std::min(s.last + 1 + kBeside, r.q_rad.size() - 1); ++k)
    found.after_rad.push_back(r.q_rad[k + 1] - r.q_rad[k]);
  return found;
}

/// A coarse sensor's jump is one quantum; where a sensor holds each reading, other jumps are as large.
bool jumps(const Readings& r, const Stretch& s, const DataFaultOptions& o) {
  const double jump = std::abs(jump_rad(r, s));
  const auto smaller = [&](double step_rad) { return jump >= o.frozen_steps * std::abs(step_rad); };
  const Beside beside = steps_beside(r, s);
  return jump >= o.frozen_quanta * r.quantum_rad && std::ranges::all_of(beside.before_rad, smaller) &&
         std::ranges::all_of(beside.after_rad, smaller);
}

/// One way, no step much smaller than another one.
bool steady(const std::vector<double>& steps_rad) {
  if (steps_rad.size() < kBeside) return false;
  const auto [low_rad, high_rad] = std::ranges::minmax(steps_rad);
  return low_rad > kSteady * high_rad ? low_rad > 0.0 : high_rad < kSteady * low_rad;
}

/// Steady motion before and after, fast enough for the jump. A joint that sticks is slower and slower before, and
/// faster and faster after it slips: after a first step twice as large as the next one it would come to rest. Where a
/// sensor holds each reading, the next one stands still as well.
bool moves_steadily(const Readings& r, const Stretch& s, const DataFaultOptions& o) {
  const Beside beside = steps_beside(r, s);
  const auto [before_rad_s, after_rad_s] = speeds_beside_rad_s(r, s);
  const double fastest_rad_s = std::max(std::abs(before_rad_s), std::abs(after_rad_s));
  return steady(beside.before_rad) && steady(beside.after_rad) &&
         std::abs(jump_rad(r, s)) < o.frozen_tolerance * fastest_rad_s * duration_s(r, s);
}

std::vector<Stretch> stretches_of(const Readings& r, const DataFaultOptions& o) {
  std::vector<Stretch> found;
  for (std::size_t first = 0; first + 1 < r.q_rad.size();) {
    Stretch s{.first = first, .last = first};
    while (s.last + 1 < r.q_rad.size() && r.q_rad[s.last + 1] == r.q_rad[first]) ++s.last;
    first = s.last + 1;
    if (s.last - s.first < kFewestRepeats) continue;
    s.jumps = jumps(r, s, o);
    s.clear = s.jumps && moves_steadily(r, s, o);
    found.push_back(s);
  }
  return found;
}

/// How far the joint moved during the stretch, by what is beside it: there and back, too.
double moved_rad(const Readings& r, const Stretch& s) {
  const auto [before_rad_s, after_rad_s] = speeds_beside_rad_s(r, s);
  const double half_s = 0.5 * duration_s(r, s);
  return std::max({std::abs(jump_rad(r, s)), std::abs(before_rad_s) * half_s, std::abs(after_rad_s) * half_s});
}

struct Run {
  std::string file;
  Readings readings;
  std::vector<Stretch> stretches;
  std::size_t count(bool Stretch::*which) const {
    return static_cast<std::size_t>(std::ranges::count_if(stretches, [&](const Stretch& s) { return s.*which; }));
  }
};

/// Numbers for the evidence, over the runs.
struct Frozen {
  std::size_t samples = 0, of = 0, stretches = 0;
  double longest_s = 0.0, jump_rad = 0.0, usual_steps = 0.0;
};

/// Repeated readings that the joint's motion contradicts: all of a run that has the fault, but rest.
std::vector<std::size_t> unknown_readings(const Run& run, double longest_s, Frozen& sum) {
  std::vector<std::size_t> found;
  const Readings& r = run.readings;
  for (const Stretch& s : run.stretches) {
    const double duration = duration_s(r, s);
    if (duration > longest_s || moved_rad(r, s) < kNatural_quanta * r.quantum_rad) continue;
    for (std::size_t k = s.first + 1; k <= s.last; ++k) found.push_back(r.sample[k]);
    ++sum.stretches;
    sum.longest_s = std::max(sum.longest_s, duration);
    if (const double jump = std::abs(jump_rad(r, s)); jump > sum.jump_rad)
      sum.jump_rad = jump, sum.usual_steps = jump / r.usual_step_rad;
  }
  sum.samples += found.size();
  sum.of += r.q_rad.size();
  return found;
}

/// Runs with the fault: some clear stretches show it. Where two runs do, jumps suffice in the others: a joint at rest
/// that starts while its readings stand still moves steadily only afterwards.
std::vector<const Run*> frozen_runs(const std::vector<Run>& runs, const DataFaultOptions& o) {
  const auto shown = std::ranges::count_if(
      runs, [&](const Run& run) { return static_cast<double>(run.count(&Stretch::clear)) >= o.frozen_stretches; });
  std::vector<const Run*> found;
  for (const Run& run : runs) {
    if (shown > 0 && run.count(shown > 1 ? &Stretch::jumps : &Stretch::clear) > 0) found.push_back(&run);
  }
  if (static_cast<double>(found.size()) < o.same_kind_share * static_cast<double>(runs.size())) return found;
  found.clear();
  for (const Run& run : runs) found.push_back(&run);
  return found;
}

}  // namespace

std::vector<DataFault> frozen_readings(const std::vector<bench::BenchRun>& runs, bool linear,
                                       const DataFaultOptions& o) {
  std::vector<Run> all;
  for (const bench::BenchRun& run : runs) {
    Run one{.file = run.file, .readings = readings_of(run.recording), .stretches = {}};
    one.stretches = stretches_of(one.readings, o);
    all.push_back(std::move(one));
  }
  const std::vector<const Run*> frozen = frozen_runs(all, o);
  if (frozen.empty()) return {};
  double longest_clear_s = 0.0;
  std::size_t clear = 0;
  for (const Run* run : frozen) {
    for (const Stretch& s : run->stretches) {
      if (s.clear) longest_clear_s = std::max(longest_clear_s, duration_s(run->readings, s)), ++clear;
    }
  }
  DataFault fault{.kind = Kind::kFrozenReadings, .where = {}, .correction = {}};
  Frozen sum;
  for (const Run* run : frozen) {
    const std::vector<std::size_t> unknown = unknown_readings(*run, kLongest * longest_clear_s, sum);
    if (unknown.empty()) continue;
    fault.fixes.push_back({.files = {run->file}, .unknown_readings = unknown});
    if (frozen.size() < all.size()) fault.files.push_back(run->file);
  }
  const std::string column = bench::column_name(bench::Column::kPosition, linear);
  const double percent = 100.0 * static_cast<double>(sum.samples) / static_cast<double>(sum.of);
  fault.where = place_of(column, fault.files);
  fault.correction =
      fmt::format("leave out the {:.2g} % of the readings that repeat the one before while the joint moves", percent);
  fault.evidence = {
      fmt::format("{} stands still {} times, for up to {:.3g} ms, {:.2g} % of the samples, while the joint moves",
                  column, sum.stretches, 1e3 * sum.longest_s, percent),
      fmt::format(
          "then it jumps to where the joint is, by up to {:.3g} {}, {:.0f} times a usual step; before and after {} "
          "of these jumps it moves steadily",
          1e3 * sum.jump_rad, linear ? "mm" : "mrad", sum.usual_steps, clear)};
  return {fault};
}

}  // namespace pmg::data_faults
