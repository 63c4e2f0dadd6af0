// Damped, bounded Gauss-Newton with finite-difference Jacobians, for motor fits and for the diagnosis.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "work/progress.hpp"

namespace pmg::fitting {

/// One unknown x_i of a fit: a value, its logarithm, or a share of its range. All members are in the unit of x_i.
struct Coordinate {
  double lower = 0.0, upper = 1.0;
  double step = 1e-3;                      ///< finite difference h of the Jacobian's column
  double expected = 0.0, deviation = 0.0;  ///< normal prior of x_i; none if deviation is 0
};
using Coordinates = std::vector<Coordinate>;

/// Simulated minus measured reading [rad], one vector per run; 0 where the sensor dropped out. Empty if the simulation
/// refuses the parameters.
using Residuals = std::vector<Eigen::VectorXd>;
/// d residual / d x, one matrix per run: rows are samples, columns coordinates [rad per unit of the coordinate].
using Jacobian = std::vector<Eigen::MatrixXd>;
/// (x) => (residuals of all runs): one rollout of every run.
using ResidualFunction = std::function<Residuals(const Eigen::VectorXd& x)>;

/// Sum of all squares [rad^2]; infinite where the residuals are empty or not finite.
double sum_of_squares(const Residuals& residuals);

/// How a column of the Jacobian is computed. Forward differences cost one rollout of every run, central ones two.
/// Central differences have a second-order error; motor fits need them to be right within 1 % despite the kinks of dry
/// friction.
enum class Differences { kForward, kCentral };

/// The problem: minimise |r(x)|^2 + prior_weight * sum(((x_i - expected_i) / deviation_i)^2) over lower <= x <= upper.
struct Problem {
  ResidualFunction residuals;
  Coordinates coordinates;
  double prior_weight = 0.0;  ///< [rad^2]
  Differences differences = Differences::kForward;
  /// A Jacobian at a nearby point, or null. Its columns are reused and cost no rollouts.
  const Jacobian* known = nullptr;
  std::vector<Eigen::Index> known_column = {};  ///< column of each coordinate in known; -1: none
};

/// (problem, x, r(x)) => (Jacobian): column i = (r(x + h e_i) - r(x)) / h, h = step_i to the side that has room; or
/// (r(x + h e_i) - r(x - h e_i)) / (2 h), each side cut at its bound. A column is 0 where the simulation refuses a
/// side. Costs one or two rollouts of every run for each column that isn't known.
Jacobian jacobian(const Problem& problem, const Eigen::VectorXd& x, const Residuals& at_x);

/// Normal equations of a linearised problem: |r + J d|^2 = squares + 2 gradient.d + d^T information d.
struct NormalEquations {
  Eigen::MatrixXd information{};  ///< J^T J
  Eigen::VectorXd gradient{};     ///< J^T r
  double squares = 0.0;           ///< r^T r
  double samples = 0.0;           ///< valid rows, or the equivalent number of independent rows

  static NormalEquations zero(Eigen::Index coordinates);
  double squares_after(const Eigen::VectorXd& step) const;
  NormalEquations& operator+=(const NormalEquations& other);
  NormalEquations& operator-=(const NormalEquations& other);
};

/// (coordinates, x, weight w) => (normal equations of w * sum(((x_i - expected_i) / deviation_i)^2)).
NormalEquations prior(const Coordinates& coordinates, const Eigen::VectorXd& x, double weight);

/// The step d from x that minimises d^T A d / 2 + g^T d within the bounds, A = information + damping * its diagonal
/// (Marquardt's scaling). Active set: the coordinate that leaves its range furthest is fixed at its bound, and the
/// others are solved again, until all are inside.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                             const Coordinates& coordinates, const Eigen::VectorXd& x, double damping);

struct GaussNewtonOptions {
  int most_iterations = 15;
  double relative_tolerance = 1e-5;  ///< stops after an iteration that lowers the objective by a smaller share; far
                                     ///< below the gains that folds can resolve
  int most_tries = 6;                ///< per iteration, each with six times the damping of the one before
  double longest_step = std::numeric_limits<double>::infinity();  ///< of one iteration, as a share of each range
  /// After the step of an iteration so many more at most, with its Jacobian corrected by what each step did, as long as
  /// the linear problem foretells what they do. Each costs one rollout of every run, not one for each coordinate.
  int most_secants = 0;
};

struct Minimum {
  Eigen::VectorXd x;
  double squares = 0.0;         ///< of the residuals alone [rad^2]
  int evaluations = 0;          ///< rollouts of all runs
  Residuals residuals = {};     ///< at x
  Jacobian jacobian_at_x = {};  ///< by differences at x itself; empty where the search ended without one
};

/// Levenberg-Marquardt (D. W. Marquardt, J. SIAM 11:431, 1963) from x. A step is taken only if it lowers the objective,
/// so the result is never worse than the start. With most_secants > 0 the Jacobian J of a step d is corrected by
///   J += (r(x + d) - r(x) - J d) (W d)^T / (d^T W d + s^2)
/// (C. G. Broyden, Math. Comp. 19:577, 1965), W = diagonal of J^T J, which makes coordinates of all units alike; s^2 =
/// mean of W_i step_i^2: a step below the finite differences says little of a jagged residual. Only a Jacobian by
/// differences ends the search. Checks for interruption before each iteration and each try.
Minimum gauss_newton(const Problem& problem, Eigen::VectorXd x, const GaussNewtonOptions& options = {},
                     const work::Progress& progress = {});

}  // namespace pmg::fitting
