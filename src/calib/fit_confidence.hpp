// How well a bench determines what was fitted to it.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"

namespace pmg::calib {

/// Of one parameter at the fit's result.
struct Confidence {
  double deviation = 0.0;        ///< one standard deviation, in the parameter's unit; infinite where nothing shows it
  std::string told_apart_badly;  ///< the parameter that could take its place, or ""
  double correlation = 0.0;      ///< with that one
};

/// (problem, point) => (confidence of each parameter), from the rollouts' derivatives at the point: the square roots of
/// fitting::cluster_robust_covariance's diagonal. Two parameters whose estimates correlate by more than 0.98 are told
/// apart badly.
std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads);

}  // namespace pmg::calib
