#include "calib/fit_confidence.hpp"

#include <cmath>
#include <limits>

#include "calib/rollout_residuals.hpp"
#include "fitting/covariance.hpp"

namespace pmg::calib {

namespace {

constexpr double kAlike = 0.98;  // correlation

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
  const fitting::Covariance covariance = fitting::cluster_robust_covariance(fit, seen);
  std::vector<Confidence> found(problem.dimensions());
  for (Confidence& one : found) one.deviation = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto d = static_cast<std::size_t>(seen[i]);
    const auto row = static_cast<Eigen::Index>(i);
    found[d].deviation = unit_per_edge(problem, point, d) * std::sqrt(std::max(0.0, covariance.robust(row, row)));
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
