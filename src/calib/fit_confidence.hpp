// Uncertainty and correlation of fitted parameters.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"

namespace pmg::calib {

/// Confidence of one parameter at the fit's result.
struct Confidence {
  /// One standard deviation, in the parameter's unit; infinite if the runs don't determine the parameter: they don't
  /// show it, or only together with others.
  double deviation = 0.0;
  std::vector<std::string> told_only_with;  ///< parameters that could change with it so that nothing moves otherwise
  std::string confounded_with;              ///< the parameter that correlates with it by more than 0.98, or ""
  double correlation = 0.0;                 ///< with that parameter
};

/// (problem, point) => (confidence of each parameter), from the rollouts' derivatives J. Columns of unit length: where
/// |J v| is below 1e-3, or below 0.1 and twice |E v|, the direction v of the parameters is blind, and these have no
/// deviation. E is what finite differences with steps twice as long change: derivatives tell no more. The others have
///
///   sqrt(A^-1 B A^-1 + d d^T), with fitting::cluster_robust_covariance's A and B,
/// where d = A^-1 J^T r is the Gauss-Newton step that a finished fit doesn't have left, the largest over J by the fit's
/// finite differences and by those 5 and 20 times as long. A parameter moves the step in which a drive leaves its
/// torque limit, and with the drive's damping that step ends at another speed: readings move by jumps, up to 2 mrad in
/// one run of a knee of 120 Nm. Short differences take jumps for information, and a search ends in one of the narrow
/// valleys between them. Differences over many jumps see what lies below. A deviation beyond a quarter of the range of
/// the search is none: the derivatives say nothing so far away.
std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads);

}  // namespace pmg::calib
