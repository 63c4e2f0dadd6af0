// A motor fit's problem: named parameters of a joint model, a bench's runs, and the loss L(eta).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "fitting/least_squares.hpp"

namespace pmg::calib {

/// A free parameter and its search range.
struct FitParameter {
  std::string name;  ///< an actuator's ("friction.coulomb_Nm"), or load.inertia_scale, load.gravity_scale
  model::Quantity quantity;
  double lower, upper;
  std::string unit() const { return std::string(model::unit(quantity)); }
  bool operator==(const FitParameter&) const = default;
};

/// (name of an actuator's or a load's parameter, bench) => (the parameter with its range on this rig). Throws
/// std::invalid_argument that lists the names.
FitParameter fit_parameter(const std::string& name, const bench::Bench& bench);

/// Of an actuator's or a load's parameter. Throws as fit_parameter does.
model::Quantity quantity(const std::string& name);

/// The paper's parameters (III-C.1: Kp, Kd, I) for this bench's drive law, and those that bench.yaml calls unknown.
std::vector<std::string> basic_parameters(const bench::Bench& bench);

/// The scales of the loads that bench.yaml calls unknown, of the point mass that stands for them: load.inertia_scale,
/// load.gravity_scale. One factor is for all loads: throws std::invalid_argument where some are known and others not.
std::vector<std::string> unknown_loads(const bench::Bench& bench);

double value(const JointModel& model, const std::string& name);
void set(JointModel& model, const std::string& name, double value);

/// A search moves in the unit cube. A parameter's scale is logarithmic if its range spans decades above 0, exponential
/// if the range starts at 0, else linear: a step then matters equally for a small servo and for a knee's drive.
class FitProblem {
 public:
  /// start: the model with its known parameters. Throws std::invalid_argument without parameters or runs.
  FitProblem(std::vector<FitParameter> parameters, JointModel start, std::vector<SingleJoint> runs);

  std::size_t dimensions() const { return parameters_.size(); }
  const std::vector<FitParameter>& parameters() const { return parameters_; }
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
  std::vector<FitParameter> parameters_;
  JointModel start_;
  std::vector<SingleJoint> runs_;
};

/// Errors of single runs, in their order.
std::vector<RolloutError> errors(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads);
RolloutError total(const std::vector<RolloutError>& errors);

}  // namespace pmg::calib
