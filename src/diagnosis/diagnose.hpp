// The diagnosis of a bench: from recordings and a model to causes.
#pragma once

#include <optional>
#include <string>

#include "bench/bench.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/options.hpp"
#include "evidence/signature.hpp"
#include "work/progress.hpp"

namespace pmg::diagnosis {

struct DiagnoseOptions {
  std::string fit, score;  ///< rows of runs.csv (bench::RowFilter); without a score everything is fitted
  std::optional<sim::ActuatorParameters> model;  ///< what the simulation has now (motor.yaml); else a fit of the basics
  unsigned threads = 1;
  unsigned seed = 1;    ///< of the bootstrap
  double step_s = 0.0;  ///< of the simulation; 0 chooses
  JointDiagnosisOptions decide_by{};
};

/// What a diagnosis was made from, for pictures.
struct DiagnosedRuns {
  std::vector<calib::SingleJoint> fitted{}, scored{};
  std::vector<evidence::Signature> checks{};  ///< without a model, on the fitted runs
};

/// Throws std::invalid_argument and model::ConfigError on bad input. Ends with what is known where progress is over.
/// The same input and seed give the same result.
Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs = nullptr,
                   const work::Progress& progress = {});

}  // namespace pmg::diagnosis
