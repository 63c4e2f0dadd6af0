// Gauss-Newton steps of a motor fit: they follow valleys in which several parameters change together.
#pragma once

#include "calib/fit_problem.hpp"
#include "calib/optimizer.hpp"

namespace pmg::calib {

/// Gauss-Newton steps (fitting/least_squares.hpp) from start, within the cube. If the load is light relative to the
/// rotor, a common factor on all torques hardly changes the rollouts. A search of one parameter at a time stops in this
/// valley; a step in all parameters follows it. The result is never worse than the start. Same input, same result.
Found gauss_newton(const FitProblem& problem, const Found& start, int most_steps, unsigned threads,
                   const work::Progress& progress = {});

}  // namespace pmg::calib
