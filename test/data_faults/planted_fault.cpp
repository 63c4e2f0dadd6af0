#include "data_faults/planted_fault.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "bench/correction.hpp"

namespace pmg::test {

namespace {

using bench::Column;
using Runs = std::vector<bench::BenchRun>;
using Random = std::mt19937;

constexpr double kDegrees = 57.29577951308232;

std::size_t any(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

void scale(Runs& runs, const std::vector<std::string>& files, Column column, double factor) {
  for (bench::BenchRun& run : runs) bench::correct(run, {.files = files, .columns = {column}, .factor = factor});
}

PlantedFault scaled(Runs& runs, const std::vector<std::string>& files, Column column, double factor,
                    const std::string& kind, const std::vector<std::string>& where) {
  scale(runs, files, column, factor);
  return {.kind = kind, .where = where, .files = files, .factor = 1.0 / factor};
}

/// A load among several whose mass in bench.yaml is 30 % too high or too low.
PlantedFault wrong_mass(Random& random, Runs& runs) {
  std::set<double> loads;
  for (const bench::BenchRun& run : runs) loads.insert(run.load.inertia_kg_m2);
  if (loads.size() < 2) return {};
  const double chosen = *std::next(loads.begin(), static_cast<long>(any(random, loads.size())));
  const double factor = any(random, 2) == 0 ? 1.3 : 0.7;
  PlantedFault fault{.kind = "mass", .where = {"loads"}, .files = {}, .factor = 1.0 / factor};
  for (bench::BenchRun& run : runs) {
    if (run.load.inertia_kg_m2 != chosen) continue;
    fault.files.push_back(run.file);
    run.load.inertia_kg_m2 *= factor;
    run.load.gravity_Nm *= factor;
  }
  return fault;
}

PlantedFault wrong_gain(Random& random, Runs& runs, double bench::BenchRun::*gain, bool all, double by = 0.0) {
  std::set<double> values;
  for (const bench::BenchRun& run : runs) values.insert(run.*gain);
  if ((!all && values.size() < 2) || *values.rbegin() == 0.0) return {};
  const double chosen = *std::next(values.begin(), static_cast<long>(any(random, values.size())));
  constexpr double kFactors[] = {2.0, 0.5, 4.0, 0.25};
  const double factor = by != 0.0 ? by : all ? kFactors[2 + any(random, 2)] : kFactors[any(random, 4)];
  PlantedFault fault{.kind = "gain_factor",
                     .where = {gain == &bench::BenchRun::kp ? "kp" : "kd"},
                     .files = {},
                     .factor = 1.0 / factor};
  for (bench::BenchRun& run : runs) {
    if (!all && run.*gain != chosen) continue;
    if (!all) fault.files.push_back(run.file);
    run.*gain *= factor;
  }
  return fault;
}

bool same_conditions(const bench::BenchRun& a, const bench::BenchRun& b) {
  return a.kp == b.kp && a.kd == b.kd && a.load == b.load;
}

/// Two rows that stand for each other: gains, load and trajectory.
PlantedFault swapped_rows(Random& random, Runs& runs) {
  for (int tries = 0; tries < 100; ++tries) {
    bench::BenchRun &a = runs[any(random, runs.size())], &b = runs[any(random, runs.size())];
    if (same_conditions(a, b)) continue;
    std::swap(a.trajectory, b.trajectory);
    std::swap(a.repeat, b.repeat);
    std::swap(a.kp, b.kp);
    std::swap(a.kd, b.kd);
    std::swap(a.load, b.load);
    return {.kind = "swapped_runs", .where = {a.file}, .files = {a.file, b.file}};
  }
  return {};
}

/// A row with the load and the gains of another row: what was recorded with the one is written down as the other.
PlantedFault wrong_row(Random& random, Runs& runs) {
  for (int tries = 0; tries < 100; ++tries) {
    bench::BenchRun& run = runs[any(random, runs.size())];
    const bench::BenchRun& like = runs[any(random, runs.size())];
    if (like.load == run.load || like.kp == run.kp) continue;
    run.kp = like.kp;
    run.kd = like.kd;
    run.load = like.load;
    return {.kind = "row", .where = {run.file}, .files = {run.file}};
  }
  return {};
}

PlantedFault shifted(Random& random, const bench::Bench& bench, Runs& runs, Column column, bool all) {
  if (bench::values(runs.front().recording, column).empty()) return {};
  const std::vector<std::string> files =
      all ? std::vector<std::string>{} : std::vector{runs[any(random, runs.size())].file};
  // Of all runs only what no drive's delay explains: readings before their commands, or long after them.
  const double sign = column == Column::kPosition && all ? -1.0 : any(random, 2) == 0 ? 1.0 : -1.0;
  const double shift_s = sign * between(random, std::max(0.05, 5.0 / bench.sample_rate_hz), 0.15);
  for (bench::BenchRun& run : runs) bench::correct(run, {.files = files, .columns = {column}, .shift_s = -shift_s});
  return {.kind = "time_shift", .where = {bench::column_name(column, false)}, .files = files, .shift_s = shift_s};
}

using Plant = std::function<PlantedFault(Random&, const bench::Bench&, Runs&)>;

std::vector<std::string> one_of(Random& random, const Runs& runs) { return {runs[any(random, runs.size())].file}; }

PlantedFault if_there(Runs& runs, Column column, const std::function<PlantedFault()>& plants) {
  for (const bench::BenchRun& run : runs) {
    for (const double value : bench::values(run.recording, column)) {
      if (value != 0.0) return plants();
    }
  }
  return {};
}

const std::map<std::string, Plant>& kinds() {
  static const std::map<std::string, Plant> kKinds = {
      {"command in degrees",
       [](Random&, const bench::Bench&, Runs& runs) {
         return scaled(runs, {}, Column::kPositionCommand, kDegrees, "unit", {"q_cmd"});
       }},
      {"readings in degrees",
       [](Random&, const bench::Bench&, Runs& runs) {
         return scaled(runs, {}, Column::kPosition, kDegrees, "unit", {" q_"});
       }},
      {"command in degrees, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kPositionCommand, kDegrees, "unit", {"q_cmd"});
       }},
      {"readings in degrees, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kPosition, kDegrees, "unit", {" q_"});
       }},
      {"feed-forward turned, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         Runs with;
         std::copy_if(runs.begin(), runs.end(), std::back_inserter(with), [](const bench::BenchRun& run) {
           return std::any_of(run.recording.tau_ff_Nm.begin(), run.recording.tau_ff_Nm.end(),
                              [](double v) { return v != 0.0; });
         });
         if (with.empty()) return PlantedFault{};
         return scaled(runs, one_of(random, with), Column::kFeedForward, -1.0, "sign", {"tau_ff"});
       }},
      {"speed turned",
       [](Random&, const bench::Bench&, Runs& runs) {
         return if_there(runs, Column::kSpeed,
                         [&] { return scaled(runs, {}, Column::kSpeed, -1.0, "sign", {" dq_rad"}); });
       }},
      {"damping of some rows", [](Random& random, const bench::Bench&,
                                  Runs& runs) { return wrong_gain(random, runs, &bench::BenchRun::kd, false); }},
      {"feed-forward in another unit, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return if_there(runs, Column::kFeedForward, [&] {
           return scaled(runs, one_of(random, runs), Column::kFeedForward, 3.0, "unit", {"tau_ff"});
         });
       }},
      {"torque in another unit",
       [](Random&, const bench::Bench&, Runs& runs) {
         return scaled(runs, {}, Column::kTorque, 3.0, "unit", {"torque_Nm"});
       }},
      {"torque in another unit, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kTorque, 0.3, "unit", {"torque_Nm"});
       }},
      {"torque turned", [](Random&, const bench::Bench&,
                           Runs& runs) { return scaled(runs, {}, Column::kTorque, -1.0, "sign", {"torque_Nm"}); }},
      {"torque turned, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kTorque, -1.0, "sign", {"torque_Nm"});
       }},
      {"gain of some rows off by a fifth",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return wrong_gain(random, runs, &bench::BenchRun::kp, false, 0.8);
       }},
      {"readings early by two samples, all runs",
       [](Random&, const bench::Bench& bench, Runs& runs) {
         const double early_s = std::max(0.015, 2.0 / bench.sample_rate_hz);
         for (bench::BenchRun& run : runs) bench::correct(run, {.columns = {Column::kPosition}, .shift_s = early_s});
         return PlantedFault{.kind = "time_shift", .where = {" q_"}, .files = {}, .shift_s = -early_s};
       }},
      {"command turned",
       [](Random&, const bench::Bench&, Runs& runs) {
         return scaled(runs, {}, Column::kPositionCommand, -1.0, "sign", {"q_cmd"});
       }},
      {"readings turned", [](Random&, const bench::Bench&,
                             Runs& runs) { return scaled(runs, {}, Column::kPosition, -1.0, "sign", {" q_"}); }},
      {"readings turned, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kPosition, -1.0, "sign", {" q_"});
       }},
      {"command turned, one run",
       [](Random& random, const bench::Bench&, Runs& runs) {
         return scaled(runs, one_of(random, runs), Column::kPositionCommand, -1.0, "sign", {"q_cmd"});
       }},
      {"mass", [](Random& random, const bench::Bench&, Runs& runs) { return wrong_mass(random, runs); }},
      {"gain of some rows", [](Random& random, const bench::Bench&,
                               Runs& runs) { return wrong_gain(random, runs, &bench::BenchRun::kp, false); }},
      {"gain of all rows",
       [](Random& random, const bench::Bench& bench, Runs& runs) {
         if (bench.law != bench::DriveLaw::kPositionPd) return PlantedFault{};
         return wrong_gain(random, runs, &bench::BenchRun::kp, true);
       }},
      {"swapped rows", [](Random& random, const bench::Bench&, Runs& runs) { return swapped_rows(random, runs); }},
      {"row of another load", [](Random& random, const bench::Bench&, Runs& runs) { return wrong_row(random, runs); }},
      {"readings shifted, one run", [](Random& random, const bench::Bench& bench,
                                       Runs& runs) { return shifted(random, bench, runs, Column::kPosition, false); }},
      {"readings early, all runs", [](Random& random, const bench::Bench& bench,
                                      Runs& runs) { return shifted(random, bench, runs, Column::kPosition, true); }},
      {"speed shifted", [](Random& random, const bench::Bench& bench,
                           Runs& runs) { return shifted(random, bench, runs, Column::kSpeed, true); }},
      {"speed in degrees",
       [](Random&, const bench::Bench&, Runs& runs) {
         return if_there(runs, Column::kSpeed,
                         [&] { return scaled(runs, {}, Column::kSpeed, kDegrees, "unit", {" dq_rad"}); });
       }},
      {"feed-forward in volts",
       [](Random&, const bench::Bench& bench, Runs& runs) {
         return if_there(runs, Column::kFeedForward, [&] {
           const double constant = bench.known.drive.torque_per_unit_Nm;
           if (bench.law == bench::DriveLaw::kPositionPd) return PlantedFault{};
           return scaled(runs, {}, Column::kFeedForward, 1.0 / constant, "unit", {"tau_ff"});
         });
       }},
      {"newtons taken for volts",
       [](Random&, const bench::Bench& bench, Runs& runs) {
         return if_there(runs, Column::kFeedForward, [&] {
           const double constant = bench.known.drive.torque_per_unit_Nm;
           if (bench.law == bench::DriveLaw::kPositionPd) return PlantedFault{};
           return scaled(runs, {}, Column::kFeedForward, constant, "unit", {"tau_ff"});
         });
       }},
      {"feed-forward turned",
       [](Random&, const bench::Bench&, Runs& runs) {
         return if_there(runs, Column::kFeedForward,
                         [&] { return scaled(runs, {}, Column::kFeedForward, -1.0, "sign", {"tau_ff"}); });
       }},
  };
  return kKinds;
}

}  // namespace

std::vector<std::string> planted_kinds() {
  std::vector<std::string> names;
  for (const auto& [name, plants] : kinds()) names.push_back(name);
  return names;
}

PlantedFault plant(const std::string& what, unsigned seed, const bench::Bench& bench, Runs& runs) {
  Random random(seed);
  return kinds().at(what)(random, bench, runs);
}

}  // namespace pmg::test
