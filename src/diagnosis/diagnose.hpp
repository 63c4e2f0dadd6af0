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
  std::string fit, score;  ///< filters of runs.csv (bench::RowFilter); with an empty score all runs are fitted
  std::optional<model::ActuatorParameters> model;  ///< present model (motor.yaml); without it the basics are fitted
  unsigned threads = 1;
  unsigned seed = 1;    ///< of the bootstrap
  double step_s = 0.0;  ///< of the simulation; 0 chooses
  JointDiagnosisOptions decide_by{};
  data_faults::ExamineOptions data{};  ///< search for data faults, and what happens to faulty data
};

/// The runs and the checks behind a diagnosis, for its page.
struct DiagnosedRuns {
  std::vector<calib::SingleJoint> fitted{}, scored{};
  std::vector<evidence::Signature> checks{};    ///< model-free checks of the fitted runs
  std::vector<evidence::Signature> expected{};  ///< the same of the simulated joint with all causes
};

/// (bench, options) => (diagnosis; runs, unless null). After an interruption the result holds the findings so far. The
/// same input and seed give the same result. Throws std::invalid_argument and files::ConfigError on bad input.
Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs = nullptr,
                   const work::Progress& progress = {});

}  // namespace pmg::diagnosis
