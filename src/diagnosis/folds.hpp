// How well a model predicts runs that it wasn't fitted to: folds inside the fitting data.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/nested_fit.hpp"

namespace pmg::diagnosis {

/// Blocks that are left out together: all of one gain, one load, or one trajectory.
struct Fold {
  std::string name;  ///< "gain", "load", "trajectory" or "time"
  std::vector<Eigen::Index> blocks;
};

/// Every block is in one fold of each kind. Kinds of which the runs have one value only are left out; where all are,
/// four stretches of time take their place.
std::vector<Fold> folds(const NestedFit& fit);

/// The step of the coordinates to the fit without each fold: one bounded Gauss-Newton step from the fit of all, that
/// keeps a twentieth of the fold's weight: an effect that a single group shows (one of two loads) isn't lost with it.
std::vector<Eigen::VectorXd> steps_without(const NestedModel& model, const std::vector<Fold>& folds);

/// Squares of each block by models that were fitted without its fold, those of its several kinds averaged: rollouts at
/// steps_without, shortened until the runs that were not left out are met better than before.
Eigen::VectorXd held_out_squares(const NestedFit& fit, const NestedModel& model, const std::vector<Fold>& folds);

/// How two models compare on the same blocks.
struct Comparison {
  double gain = 0.0;        ///< mean square of the first less that of the second [rad^2]
  double usual_gain = 0.0;  ///< the same of a usual block: of the geometric means over blocks [rad^2]
  double log_gain = 0.0;    ///< mean over blocks of log(mean square + floor) of the first less that of the second
  double deviations = 0.0;  ///< log_gain in its standard deviations, blocks as observations
  double folds_won = 0.0;   ///< share of the folds in which the second's logarithms are lower
};

/// Logarithms make a block that both models miss widely count no more than one that only the better one meets: the few
/// blocks after large steps would otherwise decide alone. floor_squares: mean square of the noise [rad^2].
class BlockComparison {
 public:
  BlockComparison(const NestedFit& fit, std::vector<Fold> folds, double floor_squares);
  Comparison operator()(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const;
  /// Mean over blocks of log(mean square + floor).
  double score(const Eigen::VectorXd& squares) const;
  const std::vector<Fold>& folds() const { return folds_; }

 private:
  Eigen::VectorXd logarithms(const Eigen::VectorXd& squares) const;
  std::vector<Fold> folds_;
  double floor_squares_;
  Eigen::VectorXd samples_;  // of each block
};

}  // namespace pmg::diagnosis
