// Gauss-Newton fits of nested models to a bench's runs: the joint's model with some parameters free.
#pragma once

#include <string>
#include <vector>

#include "calib/rollout_residuals.hpp"
#include "effects/unknowns.hpp"
#include "fitting/folds.hpp"

namespace pmg::effects {

/// A fitted model. LinearisedFit's coordinates are those of the unknowns, in their order.
struct NestedModel : fitting::LinearisedFit {
  calib::JointModel model;
  calib::Unknowns unknowns;
  /// By how much the coordinates would move with an exact integrator (step_shift()); empty: unknown.
  Eigen::VectorXd step_shift{};
};

/// Jacobian of the rollouts at a model, one column per unknown.
struct RolloutJacobian {
  calib::Unknowns unknowns;
  fitting::Jacobian of_run;
};

/// Fits models to one set of runs. `known` below is a Jacobian at a nearby model: unknowns that it contains reuse its
/// columns and cost no rollouts.
class NestedFit {
 public:
  NestedFit(std::vector<calib::SingleJoint> runs, unsigned threads)
      : runs_(std::move(runs)), threads_(threads), blocks_(calib::blocks(runs_)) {}

  const std::vector<calib::SingleJoint>& runs() const { return runs_; }
  const fitting::Blocks& blocks() const { return blocks_; }
  unsigned threads() const { return threads_; }

  /// One rollout of every run.
  fitting::Residuals residuals(const calib::JointModel& model) const {
    return calib::residuals(model, runs_, threads_);
  }
  /// One rollout of every run for each unknown.
  RolloutJacobian jacobian(const NestedModel& model, const fitting::Residuals& at_model) const;

  /// Gauss-Newton from the start's values; the result is never worse than the start. An iteration costs one
  /// rollout of every run, or, where its Jacobian is made anew, one for each unknown and one to six more.
  NestedModel fit(const calib::JointModel& start, const calib::Unknowns& unknowns, int most_iterations,
                  const RolloutJacobian* known = nullptr, double prior_weight = 0.0) const;
  /// The other unknowns, fitted beside this value of a parameter, for a few iterations.
  NestedModel beside(const NestedModel& model, const std::string& parameter, double value,
                     const RolloutJacobian* known = nullptr) const;
  /// Fills the model's blocks, at the cost of jacobian(). A fit that ended with a Jacobian at its result has them.
  void linearise(NestedModel& model, const RolloutJacobian* known = nullptr) const;

  /// (fitted model, folds) => (squares of the blocks left out).
  fitting::HeldOut held_out_squares(const NestedModel& model, const std::vector<fitting::Fold>& folds) const;

 private:
  fitting::Problem problem(const NestedModel& model, const RolloutJacobian* known = nullptr) const;

  std::vector<calib::SingleJoint> runs_;
  unsigned threads_;
  fitting::Blocks blocks_;
};

}  // namespace pmg::effects
