// Cross-validation: fits without a fold, and comparisons of two models on the blocks left out.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fitting/blocks.hpp"

namespace pmg::fitting {

/// A fit and the normal equations of each block at its solution.
struct LinearisedFit {
  Coordinates ranges{};
  Eigen::VectorXd coordinates{};          ///< x
  double squares = 0.0;                   ///< over all valid samples [rad^2]
  std::vector<NormalEquations> blocks{};  ///< at x; empty until linearised
  double prior_weight = 0.0;              ///< as Problem::prior_weight
};
NormalEquations prior(const LinearisedFit& fit);
/// What the fit minimises: its squares and its prior's [rad^2].
double cost(const LinearisedFit& fit);

/// Blocks that are left out together.
struct Fold {
  std::string name;  ///< kind of the fold, such as "gain". Each block is in one fold of each kind.
  std::vector<Eigen::Index> blocks;
};

/// (fit, folds) => (step of x to the fit without each fold): one bounded Gauss-Newton step from the fit of all blocks.
/// The fold keeps a twentieth of its weight, so that a coordinate which only this group determines (one of two loads)
/// stays determined.
std::vector<Eigen::VectorXd> steps_without(const LinearisedFit& fit, const std::vector<Fold>& folds);

/// Squares of each block by fits without its fold [rad^2]: a column for each kind of folds, in the folds' order.
struct HeldOut {
  Eigen::MatrixXd of_kind{};

  Eigen::VectorXd mean() const;  ///< over the kinds
};

/// (fit, folds) => (squares of the blocks left out): rollouts at x + s step_without, s = 1, 0.3, 0.09, with the first s
/// that lowers the objective without the fold; x if none does. Costs one to three rollouts of all runs for each fold.
HeldOut held_out_squares(const ResidualFunction& residuals, const Blocks& blocks, const LinearisedFit& fit,
                         const std::vector<Fold>& folds);

/// (fit, folds) => (the same without a rollout): the squares of block b change by what its normal equations Q_b
/// foretell of the step without its fold, beyond the step with all blocks, Q_b(step_without) - Q_b(step). For a fit
/// that isn't at its end: of its own step both have the same share.
HeldOut foretold_held_out_squares(const LinearisedFit& fit, const std::vector<Fold>& folds);

/// How two models compare where all folds of one kind are left out in turn.
struct KindComparison {
  std::string kind;                ///< as Fold::name
  double deviations = 0.0;         ///< mean over blocks of the logarithms' difference over its standard error
  double square_deviations = 0.0;  ///< the same of the mean squares, without logarithms
};

/// How two models compare on the same blocks.
struct Comparison {
  double gain = 0.0;        ///< mean square of the first less that of the second [rad^2]
  double usual_gain = 0.0;  ///< difference of the geometric means over blocks [rad^2]
  double log_gain = 0.0;    ///< mean over blocks of log(mean square + floor) of the first less that of the second
  double deviations = 0.0;  ///< log_gain over its standard error, blocks as observations
  double folds_won = 0.0;   ///< share of the folds in which the second is better, by its logarithms
  std::vector<KindComparison> of_kind{};  ///< of two HeldOut
};

/// Compares the logarithms of the blocks' mean squares. Without the logarithms, the few blocks after large steps, which
/// both models miss widely, would decide alone. floor_squares: mean square of the noise [rad^2].
class BlockComparison {
 public:
  BlockComparison(const Blocks& blocks, std::vector<Fold> folds, double floor_squares);
  /// (squares by block of the first, of the second) => (comparison).
  Comparison operator()(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const;
  /// The means over the kinds, and each kind on its own.
  Comparison operator()(const HeldOut& first, const HeldOut& second) const;
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
