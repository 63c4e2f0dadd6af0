#include "calib/gauss_newton.hpp"

namespace pmg::calib {

namespace {

// Finite-difference slopes hold for about a tenth of the range: the longest step.
constexpr fitting::GaussNewtonOptions kOptions{.relative_tolerance = 1e-6, .most_tries = 8, .longest_step = 0.1};

}  // namespace

Found gauss_newton(const FitProblem& problem, const Found& start, int most_steps, unsigned threads,
                   const work::Progress& progress) {
  fitting::GaussNewtonOptions options = kOptions;
  options.most_iterations = most_steps;
  const Eigen::VectorXd point =
      Eigen::Map<const Eigen::VectorXd>(start.point.data(), static_cast<Eigen::Index>(start.point.size()));
  const fitting::Minimum found = fitting::gauss_newton(problem.least_squares(threads), point, options, progress);
  Found best{{found.x.begin(), found.x.end()}, 0.0, found.evaluations + 1};
  best.loss = problem.loss(best.point, threads);
  return best.loss < start.loss ? best : Found{start.point, start.loss, best.evaluations};
}

}  // namespace pmg::calib
