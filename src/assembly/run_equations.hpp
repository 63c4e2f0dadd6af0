// Normal equations of every block of a bench's runs: of the model's numbers, and of those that assemblies may differ
// in.
#pragma once

#include <string>
#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::assembly {

/// A linearised model. Columns are coordinates: the model's unknowns first, then numbers that are only looked at.
struct RunEquations {
  calib::Unknowns columns;
  Eigen::VectorXd coordinates;     ///< of the columns, at the model
  fitting::NormalEquations prior;  ///< of the columns
  std::vector<fitting::NormalEquations> of_block, of_run;
  std::vector<std::size_t> run_of_block;

  Eigen::Index column(const std::string& parameter) const;  ///< -1 if there is none
  /// d coordinate / d value of a column, at the model.
  double per_value(Eigen::Index column) const;
  std::size_t runs() const { return of_run.size(); }
  /// The run says nothing from then on.
  void leave_out(std::size_t run);
};

/// (fit of runs, fitted model, columns beyond the model's unknowns) => (equations). Costs one rollout of every run for
/// each column, and two more. `at`: the fitted model with the further columns, as unknowns.
RunEquations run_equations(const effects::NestedFit& fit, const effects::NestedModel& at);

/// (fitted model, bench, scale, parameters) => (the same model with these parameters free as well, each over its whole
/// range and without a prior: what they were known to before was one number for all assemblies).
effects::NestedModel with_columns(effects::NestedModel model, const bench::Bench& bench,
                                  const effects::BenchScale& scale, const std::vector<std::string>& parameters);

}  // namespace pmg::assembly
