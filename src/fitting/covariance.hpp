// How well the runs determine the coordinates of a fit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/folds.hpp"

namespace pmg::fitting {

/// Information below this says nothing: rollouts that move by less than 1 nrad per unit of a coordinate [rad^2].
inline constexpr double kUnseen_rad2 = 1e-18;

/// Of some of a fit's coordinates, in the order of `of`.
struct Covariance {
  std::vector<Eigen::Index> of;
  Eigen::MatrixXd inverse;  ///< A^-1 of the information A = sum of J^T J and the prior's
  Eigen::MatrixXd robust;   ///< A^-1 B A^-1
};

/// (fit, coordinates) => (covariances), cluster-robust (K.-Y. Liang, S. L. Zeger, Biometrika 73:13, 1986; blocks are
/// the clusters): B = n / (n - p) * sum over the n blocks of (J^T r)(J^T r)^T for p coordinates, plus the prior's.
Covariance cluster_robust_covariance(const LinearisedFit& fit, std::vector<Eigen::Index> of);

/// Sum of the blocks' information and the prior's.
Eigen::MatrixXd information(const LinearisedFit& fit);

/// (fit, folds) => (variance of each coordinate by a jackknife over the folds): of the kind of folds that moves it
/// most, (g - 1) / g * sum over its g folds of (step_without - mean)^2. A model whose form isn't right is pulled apart
/// by groups although the blocks of each group agree.
Eigen::VectorXd jackknife_variance(const LinearisedFit& fit, const std::vector<Fold>& folds);

}  // namespace pmg::fitting
