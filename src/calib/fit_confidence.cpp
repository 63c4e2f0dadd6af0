#include "calib/fit_confidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "calib/rollout_residuals.hpp"
#include "fitting/covariance.hpp"

namespace pmg::calib {

namespace {

constexpr double kAlike = 0.98;        // correlation
constexpr double kBlind = 1e-6;        // eigenvalue of the information with a unit diagonal
constexpr double kNearlyBlind = 1e-2;  // likewise: above it columns don't cancel, however rough dry friction makes them
constexpr double kOfError = 4.0;       // times E^T E along a direction: twice what doubled steps change
constexpr double kPart = 0.01;         // of a unit direction: a parameter that belongs to it
constexpr double kMostOfEdge = 0.25;   // of a range: farther away the derivatives at the point say nothing
// Times the fit's finite differences of 1e-3 of a range, half a percent of most values. A tenth at most: there a
// rollout still follows its parameters nearly linearly.
constexpr std::array kLongerSteps = {5.0, 20.0};

/// The fit's normal equations, and how little its derivatives tell of themselves: with steps twice as long they are J +
/// E.
struct Linearised {
  fitting::LinearisedFit fit;
  Eigen::MatrixXd squares_of_E;                // E^T E
  std::vector<fitting::LinearisedFit> longer;  // by kLongerSteps
};

Linearised linearised(const FitProblem& problem, const Eigen::VectorXd& point, unsigned threads) {
  const fitting::Problem squares = problem.least_squares(threads);
  const fitting::Residuals at = squares.residuals(point);
  const auto with_steps = [&](double factor) {
    fitting::Problem with = squares;
    for (auto& coordinate : with.coordinates) coordinate.step *= factor;
    return fitting::jacobian(with, point, at);
  };
  const auto fit_with = [&](const fitting::Jacobian& jacobian) {
    fitting::LinearisedFit fit{.ranges = squares.coordinates, .coordinates = point};
    fit.blocks = blocks(problem.runs()).normal_equations(at, jacobian);
    return fit;
  };
  const fitting::Jacobian jacobian = with_steps(1.0);
  Linearised found{.fit = fit_with(jacobian), .squares_of_E = {}, .longer = {}};
  fitting::Jacobian apart = with_steps(2.0);
  for (std::size_t run = 0; run < apart.size(); ++run) apart[run] -= jacobian[run];
  found.squares_of_E = fitting::products(apart, apart);
  for (const double factor : kLongerSteps) found.longer.push_back(fit_with(with_steps(factor)));
  return found;
}

/// (fit, its covariance, seen parameters) => (standard deviation of each, in edges of the cube): sqrt(A^-1 B A^-1 + d
/// d^T).
Eigen::VectorXd deviations(const fitting::LinearisedFit& fit, const fitting::Covariance& covariance,
                           const std::vector<Eigen::Index>& seen) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(fit.coordinates.size());
  for (const fitting::NormalEquations& block : fit.blocks) gradient += block.gradient;
  const Eigen::VectorXd left = covariance.inverse * gradient(seen);
  return (covariance.robust.diagonal().cwiseMax(0.0) + left.cwiseAbs2()).cwiseSqrt();
}

using Blind = std::vector<Eigen::Index>;  // parameters that have a part in a blind direction

/// (J^T J, E^T E, seen parameters) => (parameters of each direction along which nothing moves).
std::vector<Blind> blind_directions(const Eigen::MatrixXd& information, const Eigen::MatrixXd& squares_of_E,
                                    const std::vector<Eigen::Index>& seen) {
  if (seen.empty()) return {};
  const Eigen::MatrixXd of_seen = information(seen, seen), error = squares_of_E(seen, seen);
  const Eigen::VectorXd weight = of_seen.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(weight.asDiagonal() * of_seen * weight.asDiagonal());
  std::vector<Blind> found;
  for (Eigen::Index k = 0; k < parts.eigenvalues().size(); ++k) {
    const Eigen::VectorXd v = parts.eigenvectors().col(k), of_parameters = weight.asDiagonal() * v;
    const double by_error = kOfError * of_parameters.dot(error * of_parameters);
    if (parts.eigenvalues()[k] > std::max(kBlind, std::min(kNearlyBlind, by_error))) continue;
    Blind& direction = found.emplace_back();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (std::abs(v[static_cast<Eigen::Index>(i)]) > kPart) direction.push_back(seen[i]);
    }
  }
  return found;
}

/// d value / d coordinate of a parameter at the point [its unit per edge of the cube].
double unit_per_edge(const FitProblem& problem, const std::vector<double>& point, std::size_t d) {
  constexpr double kStep = 1e-3;
  std::vector<double> below = point, above = point;
  below[d] = std::max(0.0, point[d] - kStep);
  above[d] = std::min(1.0, point[d] + kStep);
  const std::string& name = problem.parameters()[d].name;
  return (value(problem.model_at(above), name) - value(problem.model_at(below), name)) / (above[d] - below[d]);
}

}  // namespace

std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads) {
  const auto [fit, squares_of_E, longer] = linearised(
      problem, Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<Eigen::Index>(point.size())), threads);
  const Eigen::MatrixXd information = fitting::information(fit);
  std::vector<Eigen::Index> seen;
  for (Eigen::Index d = 0; d < information.rows(); ++d) {
    if (information(d, d) > fitting::kUnseen_rad2) seen.push_back(d);
  }
  std::vector<Confidence> found(problem.dimensions());
  for (Confidence& one : found) one.deviation = std::numeric_limits<double>::infinity();
  const std::vector<Blind> blind = blind_directions(information, squares_of_E, seen);
  for (const Blind& direction : blind) {
    for (const Eigen::Index d : direction) {
      std::vector<std::string>& with = found[static_cast<std::size_t>(d)].told_only_with;
      for (const Eigen::Index other : direction) {
        const std::string& name = problem.parameters()[static_cast<std::size_t>(other)].name;
        if (other != d && std::ranges::find(with, name) == with.end()) with.push_back(name);
      }
    }
  }
  const fitting::Covariance covariance = fitting::cluster_robust_covariance(fit, seen);
  Eigen::VectorXd of_edge = deviations(fit, covariance, seen);
  for (const fitting::LinearisedFit& with : longer)
    of_edge = of_edge.cwiseMax(deviations(with, fitting::cluster_robust_covariance(with, seen), seen));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto d = static_cast<std::size_t>(seen[i]);
    const auto row = static_cast<Eigen::Index>(i);
    if (found[d].told_only_with.empty() && of_edge[row] < kMostOfEdge)
      found[d].deviation = std::abs(unit_per_edge(problem, point, d)) * of_edge[row];
    for (std::size_t j = 0; j < seen.size(); ++j) {
      const auto other = static_cast<Eigen::Index>(j);
      if (j == i) continue;
      const double correlation =
          covariance.inverse(row, other) / std::sqrt(covariance.inverse(row, row) * covariance.inverse(other, other));
      if (std::abs(correlation) < std::max(kAlike, std::abs(found[d].correlation))) continue;
      found[d].correlation = correlation;
      found[d].confounded_with = problem.parameters()[static_cast<std::size_t>(seen[j])].name;
    }
  }
  return found;
}

}  // namespace pmg::calib
