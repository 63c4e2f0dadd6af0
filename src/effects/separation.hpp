// Separation of two rival models: expected from runs not recorded yet, and seen in the recorded ones.
#pragma once

#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// Expected separation if one model is the truth: the mean over blocks of log(other's mean square / truth's), over its
/// standard error. The other model is refitted, along its linearisation, to the recorded runs and the further ones.
/// With d the rms difference of both models over a block, rest the truth's rms residual (geometric mean over blocks)
/// and floor = rest^2 + noise^2, a further block adds log(1 + d^2 / floor), with the standard deviation 2 rest d /
/// (floor + d^2), as if its residuals were fully correlated. A recorded block adds a mean of 0 and its own scatter.
class Separation {
 public:
  /// Both linearised at the recorded runs. noise_squares: mean square that no model goes below [rad^2].
  Separation(const NestedModel& truth, const NestedModel& other, double noise_squares);

  /// Blocks of one further run: residuals of the other model against the true model's rollout.
  using Blocks = std::vector<fitting::NormalEquations>;

  /// Mean over its standard error, with the runs added so far, and with one run more.
  double expected_deviations() const;
  double expected_deviations_with(const Blocks& run) const;
  void add(const Blocks& run);

 private:
  double expected(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient, const Blocks* further) const;

  const NestedModel& other_;
  double usual_squares_, noise_squares_;
  double old_blocks_ = 0.0, old_squares_ = 0.0;  // recorded blocks, and their squared differences of logarithms
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  Blocks added_;
};

/// Separation of two models in the recorded runs, over the blocks in which they differ.
struct SeenSeparation {
  double deviations = 0.0;         ///< mean log-ratio over its standard error; positive if the first is better
  double share_of_expected = 0.0;  ///< mean log-ratio over its expectation if the first model is the truth
  int blocks = 0;                  ///< in which the models differ
};

/// Compares held-out squares (fitting/folds.hpp) in the blocks where the mean square d^2 of the difference of both
/// rollouts exceeds visible_share of the first model's, beyond the noise (geometric mean over blocks). In the other
/// blocks, form errors that both models share would pass for a difference.
SeenSeparation seen_separation(const NestedFit& fit, const calib::JointModel& first, const calib::JointModel& other,
                               const Eigen::VectorXd& first_held_out, const Eigen::VectorXd& other_held_out,
                               double noise_squares, double visible_share);

}  // namespace pmg::effects
