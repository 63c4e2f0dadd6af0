#include "calib/linearised.hpp"

#include <algorithm>

#include "calib/parallel.hpp"

namespace pmg::calib {

namespace {

constexpr double kStep = 1e-3;  // of the cube's edge, to either side
constexpr double kBlock_s = 0.5;

Linearised nothing(std::size_t dimensions) {
  const auto count = static_cast<Eigen::Index>(dimensions);
  return {Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count), 0};
}

Linearised linearise(const FitProblem& problem, const std::vector<double>& point, const SingleJoint& joint) {
  const auto parameters = static_cast<Eigen::Index>(problem.dimensions());
  const bench::Recording& recording = joint.run().recording;
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
  Linearised sum = nothing(problem.dimensions());
  Eigen::VectorXd block = Eigen::VectorXd::Zero(parameters);
  const auto close_block = [&] {
    sum.scatter += block * block.transpose();
    ++sum.blocks;
    block.setZero();
  };
  double block_ends_s = recording.t_s.front() + kBlock_s;
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (recording.t_s[k] >= block_ends_s) {
      close_block();
      block_ends_s += kBlock_s;
    }
    if (!recording.valid[k]) continue;
    const Eigen::VectorXd slope = slopes.row(static_cast<Eigen::Index>(k)).transpose();
    const Eigen::VectorXd part = slope * (at[k] - recording.q_rad[k]);
    sum.information += slope * slope.transpose();
    sum.gradient += part;
    block += part;
  }
  close_block();
  return sum;
}

}  // namespace

Ends ends(const std::vector<double>& point, std::size_t dimension) {
  Ends e{point, point, 0.0};
  e.below[dimension] = std::max(0.0, point[dimension] - kStep);
  e.above[dimension] = std::min(1.0, point[dimension] + kStep);
  e.apart = e.above[dimension] - e.below[dimension];
  return e;
}

Linearised linearise(const FitProblem& problem, const std::vector<double>& point, unsigned threads) {
  std::vector<Linearised> by_run(problem.runs().size());
  for_each_in_parallel(by_run.size(), threads,
                       [&](std::size_t i) { by_run[i] = linearise(problem, point, problem.runs()[i]); });
  Linearised sum = nothing(problem.dimensions());
  for (const Linearised& run : by_run) {
    sum.information += run.information;
    sum.gradient += run.gradient;
    sum.scatter += run.scatter;
    sum.blocks += run.blocks;
  }
  return sum;
}

}  // namespace pmg::calib
