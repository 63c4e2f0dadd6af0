// A fit's last steps: along valleys in which several parameters change together.
#pragma once

#include "calib/fit_problem.hpp"
#include "calib/optimizer.hpp"

namespace pmg::calib {

/// Levenberg-Marquardt on the rollouts' misses, slopes by differences, from start, within the cube. Where a joint's
/// load is light beside its rotor all torques may grow by one factor almost unpunished: searches that change one
/// parameter after the other stop in such a valley, this one sees it whole. Never worse than the start. Same input,
/// same result.
Found gauss_newton(const FitProblem& problem, const Found& start, int most_steps, unsigned threads,
                   const Interrupted& interrupted = {});

}  // namespace pmg::calib
