// How surely recordings that haven't been made yet would part two models.
#pragma once

#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::diagnosis {

/// Were one model the truth: how surely further runs would show the other one to be wrong, though it is fitted again,
/// to the runs that there are and to those, along its linearisation. A block of half a second in which they differ by d
/// (rms) is expected to weigh log(1 + d^2 / (rest^2 + noise^2)), rest being what the true one misses a usual block by,
/// and to stray as if the misses of a block were one single number. The blocks that there are say nothing in the mean,
/// and stray as they do.
class Separation {
 public:
  /// Both linearised at the runs that there are. noise_squares: mean square that no model goes below [rad^2].
  Separation(const effects::NestedModel& truth, const effects::NestedModel& other, double noise_squares);

  /// The other model's misses of the true one's rollout over the blocks of one further run.
  using Blocks = std::vector<fitting::NormalEquations>;

  /// Of a comparison by blocks (BlockComparison): its mean, in its standard deviations, with what was added.
  double expected_deviations() const;
  double expected_deviations_with(const Blocks& run) const;
  void add(const Blocks& run);

 private:
  double expected(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient, const Blocks* further) const;

  const effects::NestedModel& other_;
  double usual_squares_, noise_squares_;
  double old_blocks_ = 0.0, old_squares_ = 0.0;  // of the differences of the logarithms
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  Blocks added_;
};

/// What the runs that there are say of two models.
struct SeenSeparation {
  double deviations = 0.0;  ///< of the mean over the blocks in which the two differ, in which the first is better
  double share_of_expected = 0.0;  ///< 1: as much better as it would be were it the truth; -1: were the other one
  int blocks = 0;                  ///< in which they differ
};

/// Compares squares of blocks left out (folds.hpp) where the square of the difference of the two models' rollouts is
/// more than visible_share of the first one's residual: elsewhere nothing is said of them, and form errors that both
/// have would pass for a difference.
SeenSeparation seen_separation(const effects::NestedFit& fit, const calib::JointModel& first,
                               const calib::JointModel& other, const Eigen::VectorXd& first_held_out,
                               const Eigen::VectorXd& other_held_out, double noise_squares, double visible_share);

}  // namespace pmg::diagnosis
