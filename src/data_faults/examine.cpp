#include "data_faults/examine.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "data_faults/column_checks.hpp"
#include "data_faults/commanded_torque_check.hpp"
#include "data_faults/frozen_readings_check.hpp"
#include "data_faults/position_checks.hpp"
#include "data_faults/quick_model.hpp"
#include "data_faults/repeat_checks.hpp"
#include "data_faults/run_checks.hpp"
#include "data_faults/shared_checks.hpp"
#include "data_faults/shift_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

std::vector<bench::BenchRun> corrected(std::vector<bench::BenchRun> runs, const std::vector<DataFault>& faults) {
  for (const DataFault& fault : faults) {
    for (bench::BenchRun& run : runs) {
      for (const bench::Correction& fix : fault.fixes) bench::correct(run, fix);
    }
  }
  return runs;
}

/// True if a position of these runs is too large for radians or metres.
bool implausible(const std::vector<bench::BenchRun>& runs, bool linear) {
  return !std::ranges::all_of(runs, [&](const auto& run) { return plausible_positions(run.recording, linear); });
}

/// Adds what was found and corrects the runs. True if something was found.
bool take(const std::vector<DataFault>& faults, Examined& runs, std::vector<DataFault>& into) {
  for (const DataFault& fault : faults) runs.apply(fault.fixes);
  into.insert(into.end(), faults.begin(), faults.end());
  return !faults.empty();
}

/// Faults that the model tells, one at a time, the clearest first: each is corrected before the next one is looked for.
void take_what_the_model_tells(Examined& runs, std::vector<DataFault>& into) {
  runs.fit();
  if (take(common_shift(runs), runs, into)) runs.fit();
  while (static_cast<double>(into.size()) < runs.options().most_faults) {
    // What many runs share before what one run shows: a gain that acts by another factor makes all its rows look wrong.
    if (!take(clearest_position_fault(runs), runs, into) && !take(commanded_torque_fault(runs), runs, into) &&
        !take(gain_fault(runs), runs, into) && !take(mass_fault(runs), runs, into) &&
        !take(clearest_run_fault(runs), runs, into)) {
      return;
    }
    runs.fit();
  }
}

/// The bench with positions in whatever unit.
bench::Bench in_any_unit(bench::Bench bench) {
  bench.other_units = true;
  return bench;
}

/// The runs that any of the filters keeps, and the files of each filter: those that are fitted and those that are
/// scored.
struct FilteredRuns {
  std::vector<bench::BenchRun> runs;
  std::vector<std::vector<std::string>> groups;
};

FilteredRuns read_groups(const bench::Bench& bench, const std::vector<std::string>& filters) {
  FilteredRuns found;
  for (std::size_t f = 0; f < filters.size(); ++f) {
    if (f > 0 && filters[f].empty()) continue;  // no runs are held out
    found.groups.emplace_back();
    for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(filters[f]))) {
      found.groups.back().push_back(run.file);
      const bool there = std::ranges::any_of(found.runs, [&](const auto& other) { return other.file == run.file; });
      if (!there) found.runs.push_back(std::move(run));
    }
  }
  return found;
}

}  // namespace

Handling handling_of(const std::string& name) {
  if (name == "leave-out") return Handling::kLeaveOut;
  if (name == "correct") return Handling::kCorrect;
  if (name == "keep") return Handling::kKeep;
  throw std::invalid_argument("'" + name + "' for faulty data; expected leave-out, correct or keep");
}

const char* name(Handling handling) {
  return handling == Handling::kLeaveOut ? "leave-out" : handling == Handling::kCorrect ? "correct" : "keep";
}

bool Examination::uncorrected() const { return handling == Handling::kKeep && !faults.empty(); }

std::vector<DataFault> find_data_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                        const std::optional<model::ActuatorParameters>& model,
                                        const DataFaultOptions& options, unsigned threads) {
  // First: to all other checks a reading that stands still is late.
  std::vector<DataFault> found = frozen_readings(runs, bench.rig == bench::Rig::kLinear, options);
  Examined examined(bench, corrected(runs, found), model, options, threads);
  take(position_faults(examined), examined, found);
  take(supply_faults(bench, examined.runs(), options), examined, found);
  // Before a model is fitted, only what all runs show.
  std::vector<DataFault> of_all_runs = speed_command_faults(bench, examined.runs(), options);
  std::erase_if(of_all_runs, [](const DataFault& fault) { return !fault.files.empty(); });
  take(of_all_runs, examined, found);
  take(trajectory_faults(examined.runs(), options), examined, found);
  take(repeat_faults(examined), examined, found);
  take_what_the_model_tells(examined, found);
  const double delay_s = examined.fitted().model.actuator.command.delay_s;
  take(derived_column_faults(bench, examined.runs(), options, delay_s), examined, found);
  return found;
}

std::vector<DataFault> find_shared_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                          const calib::JointModel& model, const DataFaultOptions& options,
                                          unsigned threads) {
  std::vector<DataFault> found;
  Examined examined(bench, runs, model.actuator, options, threads);
  take(gain_fault_beside(examined, model), examined, found);
  take(mass_fault_beside(examined, model), examined, found);
  return found;
}

std::vector<DataFault> upheld(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                              const std::vector<DataFault>& faults, const calib::JointModel& model, unsigned threads) {
  const QuickModel quick(bench, model.actuator, threads);
  std::vector<DataFault> kept;
  for (std::size_t f = 0; f < faults.size(); ++f) {
    const DataFault& fault = faults[f];
    const bool judged = (fault.kind == Kind::kGainFactor || fault.kind == Kind::kMass) && !fault.files.empty();
    if (judged) {
      std::vector<DataFault> others = faults;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(f));
      std::vector<bench::BenchRun> touched = runs;
      std::erase_if(touched,
                    [&](const auto& run) { return std::ranges::find(fault.files, run.file) == fault.files.end(); });
      const auto log_error = [&](const std::vector<DataFault>& fixed) {
        return fitting::median(quick.log_errors(quick.joints(corrected(touched, fixed)), model));
      };
      if (log_error(others) <= log_error(faults)) continue;
    }
    kept.push_back(fault);
  }
  return kept;
}

std::vector<DataFault> of_used_columns(std::vector<DataFault> faults, const std::vector<bench::Column>& unused) {
  const auto is_unused = [&](const bench::Correction& fix) {
    return !fix.columns.empty() && std::ranges::all_of(fix.columns, [&](bench::Column column) {
      return std::ranges::find(unused, column) != unused.end();
    });
  };
  std::erase_if(faults, [&](const DataFault& fault) {
    return !fault.fixes.empty() && std::ranges::all_of(fault.fixes, is_unused);
  });
  return faults;
}

Examination examine(const bench::Bench& bench, const std::vector<std::string>& filters,
                    const std::optional<model::ActuatorParameters>& model, const ExamineOptions& options,
                    unsigned threads, const work::Progress& progress) {
  if (progress.report) progress.report(0.0, "looking for faults of the data");
  const auto [runs, groups] = read_groups(in_any_unit(bench), filters);
  const bool linear = bench.rig == bench::Rig::kLinear, other_units = implausible(runs, linear);
  std::vector<DataFault> faults = find_data_faults(bench, runs, model, options.decide_by, threads);
  if (other_units && implausible(corrected(runs, faults), linear)) {  // no unit: let the reader refuse it
    for (const std::string& filter : filters) (void)bench.read_runs(bench::RowFilter(filter));
  }
  Examination found = examination(of_used_columns(std::move(faults), options.unused), runs, options.handling, groups);
  found.other_units = other_units;
  found.options = options.decide_by;
  return found;
}

std::optional<Examination> examine_again(const bench::Bench& bench, const std::vector<std::string>& filters,
                                         const Examination& first, const calib::JointModel& model, unsigned threads) {
  const FilteredRuns read = read_groups(in_any_unit(bench), filters);
  std::vector<DataFault> faults = upheld(bench, read.runs, first.faults, model, threads);
  const std::vector<DataFault> more =
      find_shared_faults(bench, corrected(read.runs, faults), model, first.options, threads);
  if (more.empty() && faults.size() == first.faults.size()) return std::nullopt;
  faults.insert(faults.end(), more.begin(), more.end());
  Examination found = examination(std::move(faults), read.runs, first.handling, read.groups);
  found.other_units = first.other_units;
  found.options = first.options;
  return found;
}

Examination examination(std::vector<DataFault> faults, const std::vector<bench::BenchRun>& runs, Handling handling,
                        const std::vector<std::vector<std::string>>& groups) {
  Examination found{.faults = std::move(faults), .handling = handling};
  if (handling == Handling::kKeep) return found;
  for (std::size_t f = 0; f < found.faults.size(); ++f) {
    if (found.faults[f].kind == Kind::kFrozenReadings) {  // the other readings of its runs are right
      found.readings_left_out.push_back(f);
      continue;
    }
    std::vector<std::string> left_out = found.left_out;
    for (const std::string& file : found.faults[f].files) {
      if (std::find(left_out.begin(), left_out.end(), file) == left_out.end()) left_out.push_back(file);
    }
    const auto without = [&left_out](const std::string& file) {
      return std::find(left_out.begin(), left_out.end(), file) != left_out.end();
    };
    const bool empties_a_group = std::any_of(groups.begin(), groups.end(), [&](const std::vector<std::string>& files) {
      return std::all_of(files.begin(), files.end(), without);
    });
    const bool of_all = found.faults[f].files.empty();
    if (handling == Handling::kCorrect || of_all || 2 * left_out.size() > runs.size() || empties_a_group)
      found.corrected.push_back(f);
    else
      found.left_out = left_out;
  }
  return found;
}

bench::Bench examined_bench(const bench::Bench& bench, const Examination& examination) {
  std::vector<bench::Correction> corrections;
  for (const auto* faults : {&examination.readings_left_out, &examination.corrected}) {
    for (const std::size_t f : *faults) {
      const std::vector<bench::Correction>& fixes = examination.faults[f].fixes;
      corrections.insert(corrections.end(), fixes.begin(), fixes.end());
    }
  }
  bench::Bench found = bench::corrected(bench, corrections, examination.left_out);
  found.other_units = examination.other_units;
  return found;
}

}  // namespace pmg::data_faults
