#include "calib/fit_confidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/parallel.hpp"

namespace pmg::calib {

namespace {

constexpr double kStep = 1e-3;        // of the cube's edge, to either side
constexpr double kBlock_s = 0.5;      // a joint's motion forgets its disturbance within that
constexpr double kAlike = 0.98;       // correlation
constexpr double kUnseen_rad = 1e-9;  // movement of the rollouts by a whole edge of the cube

struct Normal {
  Eigen::MatrixXd information;  // J^T J
  Eigen::MatrixXd scatter;      // sum over blocks of (J^T e)(J^T e)^T
  int blocks = 0;
};

/// Both ends of the difference stay in the cube.
struct Ends {
  std::vector<double> below, above;
  double apart;
};

Ends ends(const std::vector<double>& point, std::size_t d) {
  Ends e{point, point, 0.0};
  e.below[d] = std::max(0.0, point[d] - kStep);
  e.above[d] = std::min(1.0, point[d] + kStep);
  e.apart = e.above[d] - e.below[d];
  return e;
}

Normal linearise(const FitProblem& problem, const std::vector<double>& point, const SingleJoint& joint) {
  const auto parameters = static_cast<Eigen::Index>(problem.dimensions());
  const Recording& recording = joint.run().recording;
  const std::vector<double> at = joint.rollout(problem.model_at(point));
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(at.size()), parameters);
  for (std::size_t d = 0; d < problem.dimensions(); ++d) {
    const Ends e = ends(point, d);
    const std::vector<double> below = joint.rollout(problem.model_at(e.below));
    const std::vector<double> above = joint.rollout(problem.model_at(e.above));
    for (std::size_t k = 0; k < at.size(); ++k) {
      slopes(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d)) = (above[k] - below[k]) / e.apart;
    }
  }
  Normal normal{Eigen::MatrixXd::Zero(parameters, parameters), Eigen::MatrixXd::Zero(parameters, parameters)};
  Eigen::VectorXd block = Eigen::VectorXd::Zero(parameters);
  double block_ends_s = recording.t_s.front() + kBlock_s;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (recording.t_s[k] >= block_ends_s || k + 1 == at.size()) {
      normal.scatter += block * block.transpose();
      ++normal.blocks;
      block.setZero();
      block_ends_s += kBlock_s;
    }
    if (!recording.valid[k]) continue;
    const Eigen::VectorXd slope = slopes.row(static_cast<Eigen::Index>(k)).transpose();
    normal.information += slope * slope.transpose();
    block += slope * (at[k] - recording.q_rad[k]);
  }
  return normal;
}

/// What a whole edge of the cube would be at the point's slope, in the parameter's unit.
double edge(const FitProblem& problem, const std::vector<double>& point, std::size_t d) {
  const std::string& name = problem.parameters()[d].name;
  const Ends e = ends(point, d);
  return (value(problem.model_at(e.above), name) - value(problem.model_at(e.below), name)) / e.apart;
}

}  // namespace

std::vector<Confidence> confidence(const FitProblem& problem, const std::vector<double>& point, unsigned threads) {
  const auto count = static_cast<Eigen::Index>(problem.dimensions());
  std::vector<Normal> by_run(problem.runs().size());
  for_each_in_parallel(by_run.size(), threads,
                       [&](std::size_t i) { by_run[i] = linearise(problem, point, problem.runs()[i]); });
  Normal sum{Eigen::MatrixXd::Zero(count, count), Eigen::MatrixXd::Zero(count, count)};
  for (const Normal& normal : by_run) {
    sum.information += normal.information;
    sum.scatter += normal.scatter;
    sum.blocks += normal.blocks;
  }
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
