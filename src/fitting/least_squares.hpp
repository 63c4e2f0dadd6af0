// Damped, bounded Gauss-Newton on residuals whose derivatives are differences: the one search of motor fits and
// diagnosis.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "work/progress.hpp"

namespace pmg::fitting {

/// One unknown x_i of a fit: a value, its logarithm, or a share of its range. All members have the coordinate's unit.
struct Coordinate {
  double lower = 0.0, upper = 1.0;
  double step = 1e-3;                      ///< of the difference that gives the Jacobian's column
  double expected = 0.0, deviation = 0.0;  ///< normal prior of x_i; none where deviation is 0
};
using Coordinates = std::vector<Coordinate>;

/// Simulated minus measured reading [rad], a vector a run; 0 where the sensor dropped out. Empty where the simulation
/// refuses the parameters.
using Residuals = std::vector<Eigen::VectorXd>;
/// d residual / d x, a matrix a run with a row a sample and a column a coordinate [rad per unit of the coordinate].
using Jacobian = std::vector<Eigen::MatrixXd>;
/// (x) => (residuals of all runs): one rollout of every run.
using ResidualFunction = std::function<Residuals(const Eigen::VectorXd& x)>;

/// Sum of all squares [rad^2]; infinite where the residuals are empty or not finite.
double sum_of_squares(const Residuals& residuals);

/// How a Jacobian's column is computed. Forward differences cost one rollout of every run, central ones two: their
/// error is of second order, which dry friction's kinks need in a fit whose parameters are to be right within a per
/// cent.
enum class Differences { kForward, kCentral };

/// What a fit minimises: |r(x)|^2 + prior_weight * sum(((x_i - expected_i) / deviation_i)^2) within lower <= x <=
/// upper.
struct Problem {
  ResidualFunction residuals;
  Coordinates coordinates;
  double prior_weight = 0.0;  ///< in squares of residuals [rad^2]
  Differences differences = Differences::kForward;
  /// Columns of a Jacobian computed nearby, used here as they are: a first look then costs the other columns alone.
  const Jacobian* known = nullptr;
  std::vector<Eigen::Index> known_column = {};  ///< of each coordinate in known; -1: none. Used where known is set.
};

/// (problem, x, r(x)) => (Jacobian): column i = (r(x + h e_i) - r(x)) / h, h = step_i to the side that has room; or
/// (r(x + h e_i) - r(x - h e_i)) / (2 h), each side cut at its bound. A column is 0 where the simulation refuses a
/// side. Costs one or two rollouts of every run for each column that isn't known.
Jacobian jacobian(const Problem& problem, const Eigen::VectorXd& x, const Residuals& at_x);

/// Sums over rows r_k of a linearised problem, J_k their derivatives: |r + J d|^2 = squares + 2 gradient.d +
/// d^T information d.
struct NormalEquations {
  Eigen::MatrixXd information{};  ///< J^T J
  Eigen::VectorXd gradient{};     ///< J^T r
  double squares = 0.0;           ///< r^T r
  double samples = 0.0;           ///< valid rows; as many as are independent, where that is known

  static NormalEquations zero(Eigen::Index coordinates);
  double squares_after(const Eigen::VectorXd& step) const;
  NormalEquations& operator+=(const NormalEquations& other);
  NormalEquations& operator-=(const NormalEquations& other);
};

/// (coordinates, x, weight w) => (normal equations of w * sum(((x_i - expected_i) / deviation_i)^2)).
NormalEquations prior(const Coordinates& coordinates, const Eigen::VectorXd& x, double weight);

/// The step d from x that minimises d^T A d / 2 + g^T d within the bounds, A = information + damping * its diagonal
/// (Marquardt's scaling). A coordinate that would leave its range stays at its bound, and the others are solved again:
/// an active set, one coordinate at a time, the furthest first.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                             const Coordinates& coordinates, const Eigen::VectorXd& x, double damping);

struct GaussNewtonOptions {
  int most_iterations = 15;
  double relative_tolerance = 1e-5;  ///< of the squares: an iteration that gains less is the last. Far below what a
                                     ///< fold can see
  int most_tries = 6;                ///< of an iteration, each with six times the damping of the one before
  double longest_step = std::numeric_limits<double>::infinity();  ///< of each coordinate's range, in one step
};

struct Minimum {
  Eigen::VectorXd x;
  double squares = 0.0;  ///< of the residuals alone [rad^2]
  int evaluations = 0;   ///< rollouts of all runs
};

/// Levenberg-Marquardt steps (D. W. Marquardt, J. SIAM 11:431, 1963) from x, a step taken only if the objective drops:
/// never worse than the start. Asks before each iteration and each try whether it is over.
Minimum gauss_newton(const Problem& problem, Eigen::VectorXd x, const GaussNewtonOptions& options = {},
                     const work::Progress& progress = {});

}  // namespace pmg::fitting
