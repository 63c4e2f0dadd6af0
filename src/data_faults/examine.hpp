// Looks for data faults in a bench before any physics is fitted, and decides what the diagnosis goes on with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "bench/correction.hpp"
#include "calib/single_joint.hpp"
#include "data_faults/data_fault.hpp"
#include "data_faults/options.hpp"
#include "model/actuator_parameters.hpp"
#include "work/progress.hpp"

namespace pmg::data_faults {

/// What happens to faulty data.
enum class Handling {
  kLeaveOut,  ///< faulty runs are left out, as long as half of the runs stay; other faults are corrected
  kCorrect,   ///< the corrections are applied
  kKeep,      ///< the data stay as they are
};

/// "leave-out", "correct" or "keep". Throws std::invalid_argument on another name.
Handling handling_of(const std::string& name);

const char* name(Handling handling);

struct ExamineOptions {
  DataFaultOptions decide_by{};
  Handling handling = Handling::kLeaveOut;
  std::vector<bench::Column> unused{};  ///< columns that the work goes on without: what is wrong in them alone is none
};

struct Examination {
  std::vector<DataFault> faults;
  Handling handling = Handling::kLeaveOut;
  std::vector<std::string> left_out{};           ///< files of runs
  std::vector<std::size_t> readings_left_out{};  ///< indices of the faults whose readings the diagnosis goes on without
  std::vector<std::size_t> corrected{};          ///< and of those whose corrections it goes on with
  bool other_units = false;    ///< positions of these runs are too large for radians or metres; a fault says why
  DataFaultOptions options{};  ///< thresholds in force
  bool uncorrected() const;    ///< faults are left in the data that the diagnosis goes on with
};

/// (bench, its runs, the simulation's model or none) => (faults, in the order in which they were found). The same input
/// gives the same result with any number of threads.
std::vector<DataFault> find_data_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                        const std::optional<model::ActuatorParameters>& model,
                                        const DataFaultOptions& options, unsigned threads);

/// A second look, beside a model that misses little, as a diagnosis leaves it: (bench, its runs, that model) => (loads
/// and gains whose numbers are wrong). A model that lacks an effect hides them.
std::vector<DataFault> find_shared_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                          const calib::JointModel& model, const DataFaultOptions& options,
                                          unsigned threads);

/// (bench, its runs as they are, faults in the order of their corrections, the model that a diagnosis left) => (faults
/// without the loads and gains whose runs this model predicts no worse as they are written). A joint that gives way or
/// swings looked as if a number were wrong.
std::vector<DataFault> upheld(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                              const std::vector<DataFault>& faults, const calib::JointModel& model, unsigned threads);

/// Without the faults that are in unused columns alone.
std::vector<DataFault> of_used_columns(std::vector<DataFault> faults, const std::vector<bench::Column>& unused);

/// (bench, filters of runs.csv, the simulation's model or none) => (examination of all runs that a filter keeps).
/// Throws as Bench::read_runs, on positions that are too large only where no fault of the data explains them.
Examination examine(const bench::Bench& bench, const std::vector<std::string>& filters,
                    const std::optional<model::ActuatorParameters>& model, const ExamineOptions& options,
                    unsigned threads, const work::Progress& progress = {});

/// (bench, filters of runs.csv, first examination, the model that a diagnosis of the rest left) => (examination without
/// the faults that are not upheld(), and with what find_shared_faults finds besides; nothing if that is the same).
std::optional<Examination> examine_again(const bench::Bench& bench, const std::vector<std::string>& filters,
                                         const Examination& first, const calib::JointModel& model, unsigned threads);

/// (faults, runs, handling, groups of files) => (what the diagnosis goes on with). A fault's runs are left out as long
/// as half of all runs stay, and one of each group: the runs that are fitted, and those that are scored. Faults whose
/// runs can't be left out are corrected. Of a fault of single readings only these are left out, not its runs.
Examination examination(std::vector<DataFault> faults, const std::vector<bench::BenchRun>& runs, Handling handling,
                        const std::vector<std::vector<std::string>>& groups = {});

/// The bench as the diagnosis goes on with it.
bench::Bench examined_bench(const bench::Bench& bench, const Examination& examination);

}  // namespace pmg::data_faults
