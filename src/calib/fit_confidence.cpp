#include "calib/fit_confidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/rollout_residuals.hpp"
#include "fitting/covariance.hpp"

namespace pmg::calib {

namespace {

constexpr double kAlike = 0.98;       // correlation
constexpr double kBlind = 1e-6;       // eigenvalue of the information with a unit diagonal; differences leave 1e-9
constexpr double kPart = 0.01;        // of a unit direction: a parameter that belongs to it
constexpr double kMostOfEdge = 0.25;  // of a range: farther away the derivatives at the point say nothing

using Blind = std::vector<Eigen::Index>;  // parameters that have a part in a blind direction

/// (J^T J, seen parameters) => (parameters of each direction along which nothing moves).
std::vector<Blind> blind_directions(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& seen) {
  if (seen.empty()) return {};
  const Eigen::MatrixXd of_seen = information(seen, seen);
  const Eigen::VectorXd weight = of_seen.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(weight.asDiagonal() * of_seen * weight.asDiagonal());
  std::vector<Blind> found;
  for (Eigen::Index k = 0; k < parts.eigenvalues().size() && parts.eigenvalues()[k] < kBlind; ++k) {
    Blind& direction = found.emplace_back();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (std::abs(parts.eigenvectors()(static_cast<Eigen::Index>(i), k)) > kPart) direction.push_back(seen[i]);
    }
  }
  return found;
}

fitting::LinearisedFit linearised(const FitProblem& problem, const Eigen::VectorXd& point, unsigned threads) {
  const fitting::Problem squares = problem.least_squares(threads);
  const fitting::Residuals at = squares.residuals(point);
  fitting::LinearisedFit fit{.ranges = squares.coordinates, .coordinates = point};
  fit.blocks = blocks(problem.runs()).normal_equations(at, fitting::jacobian(squares, point, at));
  return fit;
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
  const fitting::LinearisedFit fit = linearised(
      problem, Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<Eigen::Index>(point.size())), threads);
  const Eigen::MatrixXd information = fitting::information(fit);
  std::vector<Eigen::Index> seen;
  for (Eigen::Index d = 0; d < information.rows(); ++d) {
    if (information(d, d) > fitting::kUnseen_rad2) seen.push_back(d);
  }
  std::vector<Confidence> found(problem.dimensions());
  for (Confidence& one : found) one.deviation = std::numeric_limits<double>::infinity();
  const std::vector<Blind> blind = blind_directions(information, seen);
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
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(information.rows());
  for (const fitting::NormalEquations& block : fit.blocks) gradient += block.gradient;
  const Eigen::VectorXd left = covariance.inverse * gradient(seen);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto d = static_cast<std::size_t>(seen[i]);
    const auto row = static_cast<Eigen::Index>(i);
    const double of_edge = std::hypot(std::sqrt(std::max(0.0, covariance.robust(row, row))), left[row]);
    if (found[d].told_only_with.empty() && of_edge < kMostOfEdge)
      found[d].deviation = std::abs(unit_per_edge(problem, point, d)) * of_edge;
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
