// What is fitted to what: named parameters of a joint model, a bench's runs, and L(eta) between them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "fitting/least_squares.hpp"

namespace pmg::calib {

/// One unknown and where it is looked for.
struct FitParameter {
  std::string name;  ///< an actuator's ("friction.coulomb_Nm"), or load.inertia_scale, load.gravity_scale
  std::string unit;
  double lower, upper;
  bool operator==(const FitParameter&) const = default;
};

/// The rows of sim::actuator_parameters and of the load by name, with ranges for this rig. Throws std::invalid_argument
/// that lists the names.
FitParameter fit_parameter(const std::string& name, const bench::Bench& bench);

/// Words of the command line as names of parameters: damping, friction, delay, rate_limit, load_friction, ..., or a
/// parameter's own name. Throws std::invalid_argument that lists the words.
std::vector<std::string> effect_parameters(const std::string& word);
std::vector<std::string> effect_words();

/// What the paper fits (III-C.1: Kp, Kd, I) as this bench's drive law has it, and what bench.yaml calls unknown.
std::vector<std::string> basic_parameters(const bench::Bench& bench);

double value(const JointModel& model, const std::string& name);
void set(JointModel& model, const std::string& name, double value);

/// Points of a search are in the unit cube: logarithmic where a range spans decades above 0, exponential from 0, else
/// linear, so that a step of an optimiser means as much at a servo's end of the range as at a knee's.
class FitProblem {
 public:
  /// start: the known rest of the model. Throws std::invalid_argument without parameters or runs.
  FitProblem(std::vector<FitParameter> parameters, JointModel start, std::vector<SingleJoint> runs);

  std::size_t dimensions() const { return parameters_.size(); }
  const std::vector<FitParameter>& parameters() const { return parameters_; }
  const std::vector<SingleJoint>& runs() const { return runs_; }

  JointModel model_at(std::span<const double> point) const;
  std::vector<double> point_of(const JointModel& model) const;  ///< clamped into the cube
  const JointModel& start() const { return start_; }

  /// The point with all fitted torques, the rotor's inertia among them, larger by this factor; clamped into the cube.
  std::vector<double> with_torques_scaled(std::span<const double> point, double factor) const;

  /// L(eta) of the paper over the number of samples [rad^2], over all runs; a large number where the model makes no
  /// sense. The same whatever the number of threads.
  double loss(std::span<const double> point, unsigned threads = 1) const;

  /// The same sum of squares for Gauss-Newton steps; coordinates are points. Keeps a reference to this.
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
