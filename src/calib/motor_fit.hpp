// The fit of a joint model to a bench: many starts on few runs, then the best ones on all runs.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"
#include "calib/optimizer.hpp"
#include "work/progress.hpp"

namespace pmg::calib {

struct FitOptions {
  Method method = Method::kSbplx;  ///< of the search from each start; the final polish is always BOBYQA, then SBPLX
  unsigned starts = 8;
  unsigned screened_per_dimension = 24;  ///< points at which the loss is evaluated to find the starts
  std::size_t runs_while_searching = 16;
  int evaluations_per_dimension = 60;  ///< at most, a start and a polish; CRS2 and CMA-ES take five times that
  int newton_steps = 0;                ///< at most, on all runs before the polish; 0: none
  unsigned threads = 1;
  unsigned seed = 1;
};

/// Result of a fit. Points are in FitProblem's unit cube.
struct Fit {
  JointModel model;
  std::vector<double> point;
  double loss_rad2 = 0.0;       ///< mean square over the valid samples of all runs
  std::vector<Found> starts;    ///< result from each start on the thinned runs, best first
  std::vector<double> history;  ///< lowest loss so far at each evaluation of the polish
  int evaluations = 0;          ///< of the loss, on thinned and on all runs
  double simulated_s = 0.0;     ///< simulated joint time of all evaluations
  bool interrupted = false;     ///< true: the result is the best one so far
};

/// (problem, options) => (fit). The same problem, options and seed give the same result with any number of threads.
/// After an interruption: the best so far. Throws std::invalid_argument where no model that was tried can be simulated.
Fit fit(const FitProblem& problem, const FitOptions& options, const work::Progress& progress = {});

}  // namespace pmg::calib
