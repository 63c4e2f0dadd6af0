// Weights of the equations of motion, from what a fit leaves of them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fitting/least_squares.hpp"
#include "robot_diagnosis/robot_row.hpp"

namespace pmg::robot_diagnosis {

/// r + A theta of one row.
double residual(const RobotRow& row, const Eigen::VectorXd& theta);

/// The noise of every kind of row.
struct NoiseLevels {
  std::vector<double> variance;              ///< in the row's unit squared; 0 where there are too few rows to tell
  std::vector<double> rows_per_independent;  ///< 1 + 2 * sum of autocorrelations: noise hangs together in time

  explicit NoiseLevels(int kinds)
      : variance(static_cast<std::size_t>(kinds), 0.0), rows_per_independent(static_cast<std::size_t>(kinds), 1.0) {}

  /// 1 / ((variance + friction_variance) * rows_per_independent); 0 near standstill, where dry friction may be anything
  /// and stays the same for long: such rows say nothing.
  double weight(const RobotRow& row) const;
};

/// (blocks, theta) => (noise of each kind): rows of one kind follow each other in time.
NoiseLevels noise_levels(const std::vector<RobotBlock>& blocks, int kinds, const Eigen::VectorXd& theta);

/// (rows, noise) => (weighted normal equations at theta = 0; samples: as many rows as are independent).
fitting::NormalEquations normal_equations(std::span<const RobotRow> rows, const NoiseLevels& noise,
                                          Eigen::Index parameters);

}  // namespace pmg::robot_diagnosis
