// Noise levels and weights of the equations of motion, from a fit's residuals.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fitting/least_squares.hpp"
#include "robot_diagnosis/robot_options.hpp"
#include "robot_diagnosis/robot_row.hpp"

namespace pmg::robot_diagnosis {

/// r + A theta of one row.
double residual(const RobotRow& row, const Eigen::VectorXd& theta);

/// The noise of every kind of row.
struct NoiseLevels {
  std::vector<double> variance;              ///< in the row's unit squared; 0 with too few rows
  std::vector<double> rows_per_independent;  ///< 1 + 2 * sum of the noise's autocorrelations

  NoiseOptions options;

  explicit NoiseLevels(int kinds, const NoiseOptions& thresholds = {})
      : variance(static_cast<std::size_t>(kinds), 0.0),
        rows_per_independent(static_cast<std::size_t>(kinds), 1.0),
        options(thresholds) {}

  /// 1 / ((variance + friction_variance) * rows_per_independent); 0 near standstill, where dry friction is unknown and
  /// stays constant for long.
  double weight(const RobotRow& row) const;
};

/// (blocks, theta) => (noise of each kind). Rows of one kind must be in the order of time.
NoiseLevels noise_levels(const std::vector<RobotBlock>& blocks, int kinds, const Eigen::VectorXd& theta,
                         const NoiseOptions& options = {});

/// (rows, noise) => (weighted normal equations at theta = 0; samples: the equivalent number of independent rows).
fitting::NormalEquations normal_equations(std::span<const RobotRow> rows, const NoiseLevels& noise,
                                          Eigen::Index parameters);

}  // namespace pmg::robot_diagnosis
