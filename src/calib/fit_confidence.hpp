// Uncertainty and correlation of fitted parameters.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"

namespace pmg::calib {

/// Confidence of one parameter at the fit's result.
struct Confidence {
  double deviation = 0.0;       ///< one standard deviation, in the parameter's unit; infinite if unobservable
  std::string confounded_with;  ///< the parameter that correlates with it by more than 0.98, or ""
  double correlation = 0.0;     ///< with that parameter
};

/// (problem, point) => (confidence of each parameter), from the rollouts' derivatives at the point: the square roots of
/// fitting::cluster_robust_covariance's diagonal.
std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads);

}  // namespace pmg::calib
