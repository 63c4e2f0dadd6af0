// How well a fit predicts blocks that it was not made with: folds, and comparisons of two models on the blocks left
// out.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fitting/blocks.hpp"

namespace pmg::fitting {

/// A fit and its normal equations, block by block, at the coordinates that it found.
struct LinearisedFit {
  Coordinates ranges{};
  Eigen::VectorXd coordinates{};          ///< x
  double squares = 0.0;                   ///< over all valid samples [rad^2]
  std::vector<NormalEquations> blocks{};  ///< at x; empty until linearised
  double prior_weight = 0.0;              ///< of Problem
};
NormalEquations prior(const LinearisedFit& fit);

/// Blocks that are left out together.
struct Fold {
  std::string name;  ///< of the kind of fold, such as "gain": each block is in one fold of each kind
  std::vector<Eigen::Index> blocks;
};

/// (fit, folds) => (step of x to the fit without each fold): one bounded Gauss-Newton step from the fit of all blocks,
/// which keeps a twentieth of the fold's weight: what only one group shows (one of two loads) isn't lost with the fold.
std::vector<Eigen::VectorXd> steps_without(const LinearisedFit& fit, const std::vector<Fold>& folds);

/// (fit, folds) => (squares of each block by fits without its fold [rad^2], averaged over the kinds of folds): rollouts
/// at x + s step_without, s = 1, 0.3, 0.09: the first that meets the blocks not left out better than x does. Costs one
/// to three rollouts of all runs for each fold.
Eigen::VectorXd held_out_squares(const ResidualFunction& residuals, const Blocks& blocks, const LinearisedFit& fit,
                                 const std::vector<Fold>& folds);

/// How two models compare on the same blocks.
struct Comparison {
  double gain = 0.0;        ///< mean square of the first less that of the second [rad^2]
  double usual_gain = 0.0;  ///< the same of a usual block: of the geometric means over blocks [rad^2]
  double log_gain = 0.0;    ///< mean over blocks of log(mean square + floor) of the first less that of the second
  double deviations = 0.0;  ///< log_gain in its standard deviations, blocks as observations
  double folds_won = 0.0;   ///< share of the folds in which the second's logarithms are lower
};

/// Compares logarithms: a block that both models miss widely counts no more than one that only the better one meets;
/// otherwise the few blocks after large steps would decide alone. floor_squares: mean square of the noise [rad^2].
class BlockComparison {
 public:
  BlockComparison(const Blocks& blocks, std::vector<Fold> folds, double floor_squares);
  /// (squares by block of the first, of the second) => (comparison).
  Comparison operator()(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const;
  /// Mean over blocks of log(mean square + floor).
  double mean_log_square(const Eigen::VectorXd& squares) const;
  const std::vector<Fold>& folds() const { return folds_; }

 private:
  Eigen::VectorXd logarithms(const Eigen::VectorXd& squares) const;
  std::vector<Fold> folds_;
  double floor_squares_;
  Eigen::VectorXd samples_;  // of each block
};

}  // namespace pmg::fitting
