// A linearised model with a deviation of a parameter for each level of a column (a mixed model).
#pragma once

#include <vector>

#include "assembly/columns.hpp"
#include "assembly/run_equations.hpp"

namespace pmg::assembly {

/// One parameter that differs from level to level.
struct LevelEffect {
  Eigen::Index column = 0;  ///< of the equations
  Grouping grouping{};
  /// phi / tau^2 for levels with the standard deviation tau, where phi is the mean square that counts as one
  /// observation [rad^2 / unit^2]: a level with few runs is pulled to the mean. 0: each level on its own.
  double penalty = 0.0;
};

/// The unknowns z = (one number for all runs of each column; further numbers for all; deviations of each level from
/// the column's number, in the parameter's unit). Run r steps by M_r z: columns x unknowns.
class LevelModel {
 public:
  LevelModel(const RunEquations& equations, std::vector<LevelEffect> effects);

  /// A further number for all runs: the column's value changes in proportion to a quantity of the run.
  void add_slope(Eigen::Index column, const std::vector<double>& quantity_of_run);
  /// Fixes a column's number: it takes no part.
  void hold(Eigen::Index column);

  Eigen::Index unknowns() const { return count_; }
  Eigen::Index first_level(std::size_t effect) const { return first_level_[effect]; }
  const std::vector<LevelEffect>& effects() const { return effects_; }

  /// Sum over the runs that are not left out, with priors and penalties.
  fitting::NormalEquations sum(const std::vector<bool>& left_out = {}) const;
  /// The z of least squares, without the runs left out.
  Eigen::VectorXd solution(const std::vector<bool>& left_out = {}) const;
  /// (z, run) => (step of the columns in this run).
  Eigen::VectorXd step_of(const Eigen::VectorXd& z, std::size_t run) const { return maps_[run] * z; }
  /// Squares of each block at z [rad^2].
  Eigen::VectorXd squares(const Eigen::VectorXd& z) const;

 private:
  const RunEquations& equations_;
  std::vector<LevelEffect> effects_;
  std::vector<Eigen::Index> first_level_;
  std::vector<Eigen::MatrixXd> maps_;  // M_r
  std::vector<bool> held_;             // by unknown
  Eigen::Index count_ = 0;
};

}  // namespace pmg::assembly
