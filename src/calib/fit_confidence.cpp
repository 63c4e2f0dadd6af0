#include "calib/fit_confidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/linearised.hpp"

namespace pmg::calib {

namespace {

constexpr double kAlike = 0.98;       // correlation
constexpr double kUnseen_rad = 1e-9;  // movement of the rollouts by a whole edge of the cube

/// What a whole edge of the cube would be at the point's slope, in the parameter's unit.
double edge(const FitProblem& problem, const std::vector<double>& point, std::size_t d) {
  const std::string& name = problem.parameters()[d].name;
  const Ends e = ends(point, d);
  return (value(problem.model_at(e.above), name) - value(problem.model_at(e.below), name)) / e.apart;
}

}  // namespace

std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads) {
  const auto count = static_cast<Eigen::Index>(problem.dimensions());
  Linearised sum = linearise(problem, point, threads);
  // What the fit took from the misses, the customary correction gives back.
  const int spare = std::max(1, sum.blocks - static_cast<int>(count));
  sum.scatter *= static_cast<double>(sum.blocks) / static_cast<double>(spare);
  // A unit diagonal keeps parameters of any weight in reach of one another; the ridge stands for what can't be told
  // apart.
  const Eigen::VectorXd weight = sum.information.diagonal().cwiseSqrt().cwiseMax(kUnseen_rad);
  const Eigen::MatrixXd scale = weight.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd ridge = 1e-9 * Eigen::MatrixXd::Identity(count, count);
  const Eigen::MatrixXd inverse =
      (scale * sum.information * scale + ridge).ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd covariance = scale * inverse * scale * sum.scatter * scale * inverse * scale;

  std::vector<Confidence> found(problem.dimensions());
  for (Eigen::Index d = 0; d < count; ++d) {
    const auto index = static_cast<std::size_t>(d);
    Confidence& confidence = found[index];
    const bool unseen = sum.information(d, d) <= kUnseen_rad * kUnseen_rad;
    confidence.deviation = unseen ? std::numeric_limits<double>::infinity()
                                  : edge(problem, point, index) * std::sqrt(std::max(0.0, covariance(d, d)));
    for (Eigen::Index other = 0; other < count; ++other) {
      if (other == d || unseen) continue;
      const double correlation = inverse(d, other) / std::sqrt(inverse(d, d) * inverse(other, other));
      if (std::abs(correlation) < std::max(kAlike, std::abs(confidence.correlation))) continue;
      confidence.correlation = correlation;
      confidence.told_apart_badly = problem.parameters()[static_cast<std::size_t>(other)].name;
    }
  }
  return found;
}

}  // namespace pmg::calib
