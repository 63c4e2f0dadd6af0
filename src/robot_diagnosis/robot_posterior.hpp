// Normal priors and posteriors of a robot's parameters, and the evidence for a cause.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/least_squares.hpp"
#include "robot_diagnosis/robot_parameters.hpp"

namespace pmg::robot_diagnosis {

/// Zero-mean normal priors. The standard deviation is each parameter's tolerance, or `wide` if it belongs to a cause.
/// The list must outlive it.
class Priors {
 public:
  explicit Priors(const RobotParameterList& list) : list_(&list), wide_(list.parameters.size(), false) {}
  void widen(int candidate);
  void widen_all();
  Eigen::VectorXd precision() const;  ///< 1 / deviation^2 of each parameter
  bool wide(int candidate) const;

 private:
  const RobotParameterList* list_;
  std::vector<bool> wide_;
};

struct Posterior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// (data, priors) => ((A + P)^-1, and its product with -g): A, g the data's normal equations at 0, P the precisions.
Posterior posterior(const fitting::NormalEquations& data, const Priors& priors);

/// The posterior's mean alone.
Eigen::VectorXd posterior_mean(const fitting::NormalEquations& data, const Priors& priors);

/// (candidate, posterior, its priors' precisions) => (log Bayes factor: natural logarithm of the data's marginal
/// likelihood with wide priors of the candidate's parameters, over that with their tolerances).
double log_evidence(const RobotCandidate& candidate, const RobotParameterList& list, const Posterior& now,
                    const Eigen::VectorXd& prior_precision);

}  // namespace pmg::robot_diagnosis
