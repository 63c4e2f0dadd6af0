// A motor fit's last steps: along valleys in which several parameters change together.
#pragma once

#include "calib/fit_problem.hpp"
#include "calib/optimizer.hpp"

namespace pmg::calib {

/// Gauss-Newton steps (fitting/least_squares.hpp) from start, within the cube. Where a joint's load is light beside its
/// rotor, one factor on all torques hardly changes the rollouts: searches that change one parameter after the other
/// stop in such a valley; a step along all parameters follows it. Never worse than the start. Same input, same result.
Found gauss_newton(const FitProblem& problem, const Found& start, int most_steps, unsigned threads,
                   const work::Progress& progress = {});

}  // namespace pmg::calib
