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
constexpr double kTrusted = 0.5;   // of the gain foretold: less, and the Jacobian is too old

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

/// Broyden's correction of the Jacobian by what a step did (gauss_newton's comment).
void correct(Jacobian& slopes, const Coordinates& coordinates, const NormalEquations& at, const Eigen::VectorXd& step,
             const Residuals& before, const Residuals& after) {
  const Eigen::VectorXd weight = at.information.diagonal();
  double differences = 0.0;
  for (Eigen::Index i = 0; i < step.size(); ++i)
    differences += weight[i] * std::pow(coordinates[static_cast<std::size_t>(i)].step, 2);
  const Eigen::VectorXd weighted = weight.cwiseProduct(step);
  const double size = step.dot(weighted) + differences / static_cast<double>(step.size());
  if (!(size > 0.0)) return;
  for (std::size_t run = 0; run < slopes.size(); ++run) {
    const Eigen::VectorXd missed = after[run] - before[run] - slopes[run] * step;
    slopes[run] += missed * (weighted / size).transpose();
  }
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
  best.residuals = counted.residuals(best.x);
  best.squares = sum_of_squares(best.residuals);
  if (best.residuals.empty() || best.x.size() == 0) return best;
  double damping = kFirstDamping;
  Jacobian slopes;
  int secants = 0;  // steps since the slopes were made by differences
  bool trusted = false;
  for (int iteration = 0; iteration + (trusted ? 0 : 1) <= options.most_iterations && !progress.interrupted_now();) {
    const bool by_differences = !trusted;
    secants = by_differences ? 0 : secants + 1;
    iteration += by_differences ? 1 : 0;
    if (by_differences) slopes = jacobian(counted, best.x, best.residuals);
    NormalEquations sum = prior(problem.coordinates, best.x, problem.prior_weight);
    sum.squares += best.squares;
    for (std::size_t run = 0; run < slopes.size(); ++run) {
      sum.information += slopes[run].transpose() * slopes[run];
      sum.gradient += slopes[run].transpose() * best.residuals[run];
    }
    const double before = sum.squares, least_gain = options.relative_tolerance * before;
    const Coordinates near = within_reach(problem.coordinates, best.x, options.longest_step);
    const int most_tries = by_differences ? options.most_tries : 1;
    double gain = 0.0;
    trusted = false;
    for (int attempt = 0; attempt < most_tries && !progress.interrupted_now(); ++attempt) {
      const Eigen::VectorXd step = bounded_step(sum.information, sum.gradient, near, best.x, damping);
      const double foretold = before - sum.squares_after(step);
      if (options.most_secants > 0 && attempt == 0 && foretold <= least_gain) break;
      Residuals reached = counted.residuals(best.x + step);
      const double squares = sum_of_squares(reached);
      const double then = squares + prior(problem.coordinates, best.x + step, problem.prior_weight).squares;
      if (!(then < before)) {
        damping *= kMoreDamping;
        continue;
      }
      gain = before - then;
      trusted = secants < options.most_secants && gain > least_gain && gain > kTrusted * foretold;
      if (trusted) correct(slopes, problem.coordinates, sum, step, best.residuals, reached);
      best.x += step;
      best.squares = squares;
      best.residuals = std::move(reached);
      damping = std::max(kLeastDamping, kLessDamping * damping);
      break;
    }
    if (!by_differences || gain > least_gain) continue;
    if (gain == 0.0) best.jacobian_at_x = std::move(slopes);
    break;
  }
  return best;
}

}  // namespace pmg::fitting
