// Covariances of a fit's coordinates: cluster-robust, and by a jackknife over folds.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/folds.hpp"

namespace pmg::fitting {

/// Coordinates with less information J^T J are unobservable: an rms response below 1 nrad per unit, (1e-9 rad)^2.
inline constexpr double kUnseen_rad2 = 1e-18;

/// (A, B) => (A^-1 B) for information A = J^T J, scaled to a unit diagonal, with a ridge of 1e-9 that keeps collinear
/// coordinates solvable.
Eigen::MatrixXd solved(const Eigen::MatrixXd& information, const Eigen::MatrixXd& right);

/// (Jacobian J, columns X with the same rows) => J^T X, summed over the runs.
template <typename Columns>
Eigen::MatrixXd products(const Jacobian& jacobian, const std::vector<Columns>& columns) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(jacobian.front().cols(), columns.front().cols());
  for (std::size_t run = 0; run < jacobian.size(); ++run) sum += jacobian[run].transpose() * columns[run];
  return sum;
}

/// (X^T X, J^T X, J^T J) => what remains of X^T X beyond what the columns of J can make,
///   X^T X - X^T J (J^T J)^-1 J^T X.
Eigen::MatrixXd beyond(const Eigen::MatrixXd& own, const Eigen::MatrixXd& mixed, const Eigen::MatrixXd& information);

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

/// (fit, its covariance) => (degrees of freedom of each robust variance): the effective number of blocks, as L. Kish
/// counts unequal weights (Survey Sampling, 1965), (A^-1)_ii^2 / sum over the blocks b of (A^-1 A_b A^-1)_ii^2. A
/// block's weight is its part of the variance where all blocks scatter alike. A number that few blocks determine has
/// few observations, however many blocks there are (F. E. Satterthwaite, Biometrics Bulletin 2:110, 1946; A. V. Carter,
/// K. T. Schnepel, D. G. Steigerwald, Review of Economics and Statistics 99:698, 2017). A prior adds to the sum, but is
/// no estimate: it adds to the freedom.
Eigen::VectorXd effective_blocks(const LinearisedFit& fit, const Covariance& covariance);

/// Sum of the blocks' information and the prior's.
Eigen::MatrixXd information(const LinearisedFit& fit);

/// (fit, folds) => (jackknife variance of each coordinate): (g - 1) / g * sum over the g folds of a kind of
/// (step_without - mean)^2, the largest over the kinds of folds. A model of the wrong form fits each group differently
/// although the blocks within a group agree; the cluster-robust covariance misses that.
Eigen::VectorXd jackknife_variance(const LinearisedFit& fit, const std::vector<Fold>& folds);

}  // namespace pmg::fitting
