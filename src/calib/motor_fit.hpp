// The fit of a joint model to a bench: many starts on few runs, then the best of them on all runs.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"
#include "calib/optimizer.hpp"
#include "work/progress.hpp"

namespace pmg::calib {

struct FitOptions {
  Method method = Method::kSbplx;  ///< of the starts; the last polish is always BOBYQA and SBPLX
  unsigned starts = 8;
  unsigned screened_per_dimension = 24;  ///< points at which the loss is looked at to find the starts
  std::size_t runs_while_searching = 16;
  int evaluations_per_dimension = 60;  ///< at most, a start and a polish; CRS2 and CMA-ES take five times that
  int newton_steps = 0;                ///< at most, on all runs before the polish (gauss_newton.hpp); 0: none
  unsigned threads = 1;
  unsigned seed = 1;
};

/// What a fit found. Points are FitProblem's.
struct Fit {
  JointModel model;
  std::vector<double> point;
  double loss_rad2 = 0.0;       ///< mean square over the valid samples of all runs
  std::vector<Found> starts;    ///< where each start got to, on the thinned runs, best first
  std::vector<double> history;  ///< lowest loss so far at each evaluation of the polish
  int evaluations = 0;          ///< of everything, thinned runs or all
  double simulated_s = 0.0;     ///< of joint time, in all evaluations
  bool interrupted = false;     ///< the best until then
};

/// Same problem, options and seed: same result, whatever the number of threads. Where progress is over: the best so
/// far.
Fit fit(const FitProblem& problem, const FitOptions& options, const work::Progress& progress = {});

}  // namespace pmg::calib
