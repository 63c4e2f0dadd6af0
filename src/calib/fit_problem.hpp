// A motor fit's problem: named parameters of a joint model, a bench's runs, and the loss L(eta).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/unknown.hpp"

namespace pmg::calib {

/// A search moves in the unit cube: in shares of the parameters' ranges, on the scales that these have.
class FitProblem {
 public:
  /// start: the model with its known parameters. Throws std::invalid_argument without parameters or runs.
  FitProblem(Unknowns parameters, JointModel start, std::vector<SingleJoint> runs);

  std::size_t dimensions() const { return parameters_.size(); }
  const Unknowns& parameters() const { return parameters_; }
  const std::vector<SingleJoint>& runs() const { return runs_; }

  JointModel model_at(std::span<const double> point) const;
  std::vector<double> point_of(const JointModel& model) const;  ///< clamped into the cube
  const JointModel& start() const { return start_; }

  /// The point with all fitted torques and the rotor's inertia multiplied by this factor; clamped into the cube.
  std::vector<double> with_torques_scaled(std::span<const double> point, double factor) const;

  /// L(eta) of the paper over the number of samples: mean square of simulated minus measured reading over all runs
  /// [rad^2]; 1e6 if the model is invalid. Does not depend on the number of threads.
  double loss(std::span<const double> point, unsigned threads = 1) const;

  /// Throws std::invalid_argument that says why the model at the point can't be simulated, if it can't.
  void expect_simulated(std::span<const double> point) const;

  /// The same problem for Gauss-Newton steps; coordinates are points of the cube. Refers to this object.
  fitting::Problem least_squares(unsigned threads) const;

  /// The same problem on fewer runs, spread evenly over the list.
  FitProblem thinned(std::size_t most_runs) const;

 private:
  Unknowns parameters_;
  JointModel start_;
  std::vector<SingleJoint> runs_;
};

/// Errors of single runs, in their order.
std::vector<RolloutError> errors(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads);
RolloutError total(const std::vector<RolloutError>& errors);

}  // namespace pmg::calib
