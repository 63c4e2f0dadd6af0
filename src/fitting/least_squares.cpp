#include "fitting/least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace pmg::fitting {

namespace {

constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-6, kLessDamping = 0.2, kMoreDamping = 6.0;
constexpr double kUnseen = 1e-14;  // of the largest information: an unobservable coordinate keeps its value
constexpr double kRidge = 1e-9;    // added to a unit diagonal: keeps collinear coordinates solvable

/// (coordinates, x, longest step) => (coordinates with bounds at most one longest step from x).
Coordinates within_reach(const Coordinates& coordinates, const Eigen::VectorXd& x, double longest_step) {
  Coordinates near = coordinates;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double reach = longest_step * (near[i].upper - near[i].lower), place = x[static_cast<Eigen::Index>(i)];
    near[i].lower = std::max(near[i].lower, place - reach);
    near[i].upper = std::min(near[i].upper, place + reach);
  }
  return near;
}

/// The two points of a coordinate's difference; for a forward difference the first is x.
std::pair<double, double> ends(const Coordinate& c, double x, Differences differences) {
  if (differences == Differences::kCentral) return {std::max(c.lower, x - c.step), std::min(c.upper, x + c.step)};
  double step = c.step;
  if (x + step > c.upper) step = -step;
  if (x + step < c.lower) step = 0.5 * (c.upper - c.lower);
  return {x, x + step};
}

}  // namespace

double sum_of_squares(const Residuals& residuals) {
  if (residuals.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Eigen::VectorXd& run : residuals) sum += run.squaredNorm();
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

Jacobian jacobian(const Problem& problem, const Eigen::VectorXd& x, const Residuals& at_x) {
  Jacobian found(at_x.size());
  for (std::size_t run = 0; run < at_x.size(); ++run) found[run].setZero(at_x[run].size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (problem.known != nullptr && problem.known_column[index] >= 0) {
      for (std::size_t run = 0; run < at_x.size(); ++run)
        found[run].col(i) = (*problem.known)[run].col(problem.known_column[index]);
      continue;
    }
    const auto [from, to] = ends(problem.coordinates[index], x[i], problem.differences);
    const auto residuals_at = [&](double place) {
      Eigen::VectorXd moved = x;
      moved[i] = place;
      return place == x[i] ? at_x : problem.residuals(moved);
    };
    const Residuals above = residuals_at(to), below = residuals_at(from);
    if (above.empty() || below.empty()) continue;
    for (std::size_t run = 0; run < at_x.size(); ++run) found[run].col(i) = (above[run] - below[run]) / (to - from);
  }
  return found;
}

NormalEquations NormalEquations::zero(Eigen::Index coordinates) {
  return {Eigen::MatrixXd::Zero(coordinates, coordinates), Eigen::VectorXd::Zero(coordinates)};
}

double NormalEquations::squares_after(const Eigen::VectorXd& step) const {
  return squares + 2.0 * gradient.dot(step) + step.dot(information * step);
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  information += other.information;
  gradient += other.gradient;
  squares += other.squares;
  samples += other.samples;
  return *this;
}

NormalEquations& NormalEquations::operator-=(const NormalEquations& other) {
  information -= other.information;
  gradient -= other.gradient;
  squares -= other.squares;
  samples -= other.samples;
  return *this;
}

NormalEquations prior(const Coordinates& coordinates, const Eigen::VectorXd& x, double weight) {
  NormalEquations found = NormalEquations::zero(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Coordinate& c = coordinates[static_cast<std::size_t>(i)];
    if (!(c.deviation > 0.0)) continue;
    const double off = (x[i] - c.expected) / c.deviation;
    found.information(i, i) = weight / (c.deviation * c.deviation);
    found.gradient[i] = weight * off / c.deviation;
    found.squares += weight * off * off;
  }
  return found;
}

Eigen::VectorXd bounded_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                             const Coordinates& coordinates, const Eigen::VectorXd& x, double damping) {
  const Eigen::Index count = x.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  const double largest = information.diagonal().maxCoeff();
  std::vector<bool> held(static_cast<std::size_t>(count), false);
  for (Eigen::Index round = 0; round <= count; ++round) {
    Eigen::MatrixXd a = information;
    Eigen::VectorXd b = -gradient;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (held[static_cast<std::size_t>(i)]) b -= information.col(i) * step[i];
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool unseen = !(information(i, i) > kUnseen * largest);
      if (held[static_cast<std::size_t>(i)] || unseen) {
        a.row(i).setZero();
        a.col(i).setZero();
        a(i, i) = 1.0;
        b[i] = held[static_cast<std::size_t>(i)] ? step[i] : 0.0;
      } else {
        a(i, i) *= 1.0 + damping;
      }
    }
    const Eigen::VectorXd weight = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = weight.asDiagonal() * a * weight.asDiagonal();
    const Eigen::MatrixXd ridge = kRidge * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd solved = weight.asDiagonal() * (scaled + ridge).ldlt().solve(weight.asDiagonal() * b);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!held[static_cast<std::size_t>(i)]) step[i] = solved[i];
    }
    // Fix only the coordinate furthest outside: with it fixed, the others may stay inside.
    Eigen::Index furthest = -1;
    double most = 1e-12;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Coordinate& c = coordinates[static_cast<std::size_t>(i)];
      const double there = x[i] + step[i];
      const double out = std::abs(there - std::clamp(there, c.lower, c.upper)) / (c.upper - c.lower);
      if (held[static_cast<std::size_t>(i)] || out <= most) continue;
      furthest = i;
      most = out;
    }
    if (furthest < 0) break;
    const Coordinate& c = coordinates[static_cast<std::size_t>(furthest)];
    held[static_cast<std::size_t>(furthest)] = true;
    step[furthest] = std::clamp(x[furthest] + step[furthest], c.lower, c.upper) - x[furthest];
  }
  return step;
}

Minimum gauss_newton(const Problem& problem, Eigen::VectorXd x, const GaussNewtonOptions& options,
                     const work::Progress& progress) {
  Minimum best{std::move(x)};
  Problem counted = problem;
  counted.residuals = [&](const Eigen::VectorXd& there) {
    ++best.evaluations;
    return problem.residuals(there);
  };
  Residuals residuals = counted.residuals(best.x);
  best.squares = sum_of_squares(residuals);
  if (residuals.empty() || best.x.size() == 0) return best;
  double damping = kFirstDamping;
  for (int iteration = 0; iteration < options.most_iterations && !progress.interrupted_now(); ++iteration) {
    const Jacobian slopes = jacobian(counted, best.x, residuals);
    NormalEquations sum = prior(problem.coordinates, best.x, problem.prior_weight);
    const double before = best.squares + sum.squares;
    for (std::size_t run = 0; run < residuals.size(); ++run) {
      sum.information += slopes[run].transpose() * slopes[run];
      sum.gradient += slopes[run].transpose() * residuals[run];
    }
    const Coordinates near = within_reach(problem.coordinates, best.x, options.longest_step);
    double now = before;
    for (int attempt = 0; attempt < options.most_tries && !progress.interrupted_now(); ++attempt) {
      const Eigen::VectorXd there = best.x + bounded_step(sum.information, sum.gradient, near, best.x, damping);
      Residuals reached = counted.residuals(there);
      const double squares = sum_of_squares(reached);
      const double then = squares + prior(problem.coordinates, there, problem.prior_weight).squares;
      if (then < before) {
        best.x = there;
        best.squares = squares;
        now = then;
        residuals = std::move(reached);
        damping = std::max(kLeastDamping, kLessDamping * damping);
        break;
      }
      damping *= kMoreDamping;
    }
    if (before - now <= options.relative_tolerance * before) break;
  }
  return best;
}

}  // namespace pmg::fitting
