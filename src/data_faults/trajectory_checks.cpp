#include "data_faults/trajectory_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pmg::data_faults {

namespace {

constexpr std::size_t kCompared = 6;  // runs of a trajectory that another run is compared with
constexpr double kLengthShare = 0.02;

using Runs = std::vector<bench::BenchRun>;

/// Of up to kCompared other runs of a trajectory: how many there are, and how many have this run's commands.
struct Agreement {
  std::size_t compared = 0, same = 0;
  bool all() const { return compared > 0 && same == compared; }
  bool none() const { return compared > 0 && same == 0; }
};

Agreement agreement(const Runs& runs, std::size_t run, const std::vector<std::size_t>& others,
                    const DataFaultOptions& options) {
  Agreement found;
  for (const std::size_t other : others) {
    if (other == run || found.compared == kCompared) continue;
    ++found.compared;
    if (same_commands(runs[run], runs[other], 1.0, options)) ++found.same;
  }
  return found;
}

bench::Correction row_of(const bench::BenchRun& run, const bench::RowConditions& conditions) {
  return {.files = {run.file}, .columns = {}, .conditions = conditions};
}

}  // namespace

bench::RowConditions conditions_of(const bench::BenchRun& run) {
  return {.trajectory = run.trajectory, .repeat = run.repeat, .kp = run.kp, .kd = run.kd, .load = run.load};
}

bool same_commands(const bench::BenchRun& a, const bench::BenchRun& b, double factor, const DataFaultOptions& options) {
  const std::vector<double>&x = a.recording.q_cmd_rad, &y = b.recording.q_cmd_rad;
  const std::size_t count = std::min(x.size(), y.size());
  if (static_cast<double>(std::max(x.size(), y.size()) - count) > kLengthShare * static_cast<double>(count))
    return false;
  double apart = 0.0, size = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    apart += std::pow(factor * x[k] - y[k], 2);
    size += std::pow(y[k] - y[0], 2);
  }
  return size > 0.0 && apart <= std::pow(options.command_difference, 2) * size;
}

DataFault swapped_runs(const bench::BenchRun& one, const bench::BenchRun& other, std::vector<std::string> evidence) {
  return {.kind = Kind::kSwappedRuns,
          .where = fmt::format("runs.csv, rows {} and {}", one.file, other.file),
          .correction = fmt::format("exchange the files {} and {} in runs.csv", one.file, other.file),
          .evidence = std::move(evidence),
          .fixes = {row_of(one, conditions_of(other)), row_of(other, conditions_of(one))},
          .files = {one.file, other.file}};
}

std::vector<DataFault> trajectory_faults(const Runs& runs, const DataFaultOptions& options) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < runs.size(); ++i) groups[runs[i].trajectory].push_back(i);
  if (groups.size() < 2) return {};
  struct Stranger {
    std::size_t run;
    std::string looks_like;
  };
  std::vector<Stranger> strangers;
  for (const auto& [name, members] : groups) {
    std::vector<Stranger> here;
    std::size_t alike = 0;
    for (const std::size_t run : members) {
      const Agreement own = agreement(runs, run, members, options);
      if (2 * own.same >= own.compared && own.compared > 0) ++alike;
      if (!own.none() && own.compared > 0) continue;
      for (const auto& [other, others] : groups) {
        if (other != name && agreement(runs, run, others, options).same > 0) here.push_back({run, other});
      }
    }
    // A trajectory whose recordings all differ has a name that says nothing of the commands.
    if (alike >= 2 || members.size() <= 2) strangers.insert(strangers.end(), here.begin(), here.end());
  }
  std::vector<DataFault> found;
  std::vector<bool> done(runs.size(), false);
  for (const Stranger& one : strangers) {
    if (done[one.run]) continue;
    done[one.run] = true;
    const bench::BenchRun& run = runs[one.run];
    const auto partner = std::find_if(strangers.begin(), strangers.end(), [&](const Stranger& other) {
      return !done[other.run] && runs[other.run].trajectory == one.looks_like && other.looks_like == run.trajectory;
    });
    if (partner != strangers.end()) {
      done[partner->run] = true;
      const bench::BenchRun& other = runs[partner->run];
      found.push_back(swapped_runs(run, other,
                                   {fmt::format("{} has the commands of the trajectory {}, {} those of {}", run.file,
                                                one.looks_like, other.file, run.trajectory)}));
      continue;
    }
    bench::RowConditions named = conditions_of(run);
    named.trajectory = one.looks_like;
    found.push_back({.kind = Kind::kRow,
                     .where = fmt::format("runs.csv, row {}", run.file),
                     .correction = fmt::format("its trajectory is {}, not {}", one.looks_like, run.trajectory),
                     .evidence = {fmt::format("{} has the commands of {}, and none of its own trajectory's", run.file,
                                              one.looks_like)},
                     .fixes = {row_of(run, named)},
                     .files = {run.file}});
  }
  return found;
}

}  // namespace pmg::data_faults
