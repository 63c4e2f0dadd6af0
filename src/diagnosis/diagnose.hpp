// The diagnosis of a bench: from recordings and a model to causes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bench/bench.hpp"
#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis {

struct DiagnoseOptions {
  std::string fit, score;  ///< rows of runs.csv (bench::RowFilter); without a score everything is fitted
  std::optional<sim::ActuatorParameters> model;  ///< what the simulation has now (motor.yaml); else a fit of the basics
  unsigned threads = 1;
  unsigned seed = 1;    ///< of the bootstrap
  double step_s = 0.0;  ///< of the simulation; 0 chooses
};

/// What a diagnosis was made from, for pictures.
struct DiagnosedRuns {
  std::vector<calib::SingleJoint> fitted, scored;
};

/// Called now and then with how far it is and what is done; false ends it with what is known.
using DiagnoseProgress = std::function<bool(double share, const std::string& text)>;

/// Throws std::invalid_argument and model::ConfigError on bad input. The same input and seed give the same result.
Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs = nullptr,
                   const DiagnoseProgress& progress = {});

}  // namespace pmg::diagnosis
