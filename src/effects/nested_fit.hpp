// Fits of nested models to a bench's runs: the joint's model with some parameters free, by Gauss-Newton steps.
#pragma once

#include <vector>

#include "calib/rollout_residuals.hpp"
#include "effects/unknowns.hpp"
#include "fitting/folds.hpp"

namespace pmg::effects {

/// A fitted model; coordinates are those of the unknowns.
struct NestedModel : fitting::LinearisedFit {
  calib::JointModel model;
  std::vector<Unknown> unknowns;
};

/// (model, coordinates) => (the joint's model with its unknowns there).
calib::JointModel model_at(const NestedModel& model, const Eigen::VectorXd& coordinates);

/// Derivatives of the rollouts at a model; columns are the unknowns'.
struct RolloutJacobian {
  std::vector<Unknown> unknowns;
  fitting::Jacobian of_run;
};

/// The runs that models are fitted to. `known` below: derivatives at a model nearby; unknowns that it has as well take
/// its columns instead of rollouts of their own.
class NestedFit {
 public:
  NestedFit(std::vector<calib::SingleJoint> runs, unsigned threads)
      : runs_(std::move(runs)), threads_(threads), blocks_(calib::blocks(runs_)) {}

  const std::vector<calib::SingleJoint>& runs() const { return runs_; }
  const fitting::Blocks& blocks() const { return blocks_; }

  /// One rollout of every run.
  fitting::Residuals residuals(const calib::JointModel& model) const {
    return calib::residuals(model, runs_, threads_);
  }
  /// One rollout of every run for each unknown.
  RolloutJacobian jacobian(const NestedModel& model, const fitting::Residuals& at_model) const;

  /// From the start's values; never worse than the start. Each iteration costs a rollout for each unknown, and one to
  /// six more.
  NestedModel fit(const calib::JointModel& start, const std::vector<Unknown>& unknowns, int most_iterations,
                  const RolloutJacobian* known = nullptr, double prior_weight = 0.0) const;
  /// Fills the model's blocks, at the cost of jacobian().
  void linearise(NestedModel& model, const RolloutJacobian* known = nullptr) const;

  /// (fitted model, folds) => (squares of each block by fits without its fold).
  Eigen::VectorXd held_out_squares(const NestedModel& model, const std::vector<fitting::Fold>& folds) const;

 private:
  fitting::Problem problem(const NestedModel& model, const RolloutJacobian* known = nullptr) const;

  std::vector<calib::SingleJoint> runs_;
  unsigned threads_;
  fitting::Blocks blocks_;
};

}  // namespace pmg::effects
