// Runs under examination: with the corrections found so far, the quick model, and what it says of each run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "data_faults/data_fault.hpp"
#include "data_faults/options.hpp"
#include "data_faults/quick_model.hpp"

namespace pmg::data_faults {

class Examined {
 public:
  Examined(const bench::Bench& bench, std::vector<bench::BenchRun> runs,
           const std::optional<model::ActuatorParameters>& given, const DataFaultOptions& options, unsigned threads);

  const bench::Bench& bench() const { return *bench_; }
  const std::vector<bench::BenchRun>& runs() const { return runs_; }
  const DataFaultOptions& options() const { return options_; }
  const QuickModel& model() const { return model_; }
  bool linear() const { return bench_->rig == bench::Rig::kLinear; }
  double sample_s() const { return 1.0 / bench_->sample_rate_hz; }

  /// Corrects the runs. A fit that there is no longer holds.
  void apply(const std::vector<bench::Correction>& corrections);
  /// The runs with further corrections.
  std::vector<bench::BenchRun> with(const std::vector<bench::Correction>& corrections) const;

  /// Fits the quick model, from the last fit if there is one, and computes every run's error.
  void fit();
  const QuickFit& fitted() const { return *fit_; }
  const std::vector<double>& log_error() const { return log_error_; }  ///< of every run
  /// ln of an error that is still usual among the runs.
  double usual_log_error() const;
  /// A usual run's error over that of a perfect model, which misses what differs between repeats; infinite without
  /// repeats.
  double floors(const QuickFit& fit) const;
  /// ln of the error that a perfect model would have; minus infinity without repeats.
  double log_floor() const;

  /// Few runs, spread over all, for fits: indices.
  const std::vector<std::size_t>& few() const { return few_; }
  std::vector<calib::SingleJoint> few_of(const std::vector<bench::BenchRun>& runs) const;

 private:
  const bench::Bench* bench_;
  std::vector<bench::BenchRun> runs_;
  DataFaultOptions options_;
  QuickModel model_;
  std::vector<std::size_t> few_;
  std::optional<QuickFit> fit_;
  std::vector<double> log_error_;
  double floor_rad_;
};

}  // namespace pmg::data_faults
