// Normal priors and posteriors of a robot's parameters, and the evidence for a cause.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/least_squares.hpp"
#include "robot_diagnosis/robot_parameters.hpp"

namespace pmg::robot_diagnosis {

/// Zero-mean normal priors: of each parameter's tolerance, or wide where a cause was found. Keeps a reference to the
/// list.
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

/// (candidate, posterior, precisions of the priors in it) => (natural logarithm of how much more probable the data are
/// when the candidate's parameters have their wide priors than when they have their tolerances).
double log_evidence(const RobotCandidate& candidate, const RobotParameterList& list, const Posterior& now,
                    const Eigen::VectorXd& prior_precision);

}  // namespace pmg::robot_diagnosis
