// Covariances of a fit's coordinates: cluster-robust, and by a jackknife over folds.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/folds.hpp"

namespace pmg::fitting {

/// Coordinates with less information J^T J are unobservable: an rms response below 1 nrad per unit, (1e-9 rad)^2.
inline constexpr double kUnseen_rad2 = 1e-18;

/// Covariance of the coordinates `of` of a fit, in their order.
struct Covariance {
  std::vector<Eigen::Index> of;
  Eigen::MatrixXd inverse;  ///< A^-1, with the information A = J^T J + the prior's
  Eigen::MatrixXd robust;   ///< A^-1 B A^-1
};

/// (fit, coordinates) => (covariances), cluster-robust (K.-Y. Liang, S. L. Zeger, Biometrika 73:13, 1986; blocks are
/// the clusters): B = n / (n - p) * sum over the n blocks of (J^T r)(J^T r)^T for p coordinates, plus prior_weight
/// times the prior's information.
Covariance cluster_robust_covariance(const LinearisedFit& fit, std::vector<Eigen::Index> of);

/// Sum of the blocks' information and the prior's.
Eigen::MatrixXd information(const LinearisedFit& fit);

/// (fit, folds) => (jackknife variance of each coordinate): (g - 1) / g * sum over the g folds of a kind of
/// (step_without - mean)^2, the largest over the kinds of folds. A model of the wrong form fits each group differently
/// although the blocks within a group agree; the cluster-robust covariance misses that.
Eigen::VectorXd jackknife_variance(const LinearisedFit& fit, const std::vector<Fold>& folds);

}  // namespace pmg::fitting
