#include "fitting/folds.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::fitting {

namespace {

constexpr double kKept = 0.05;         // share of a fold's weight
constexpr double kFoldDamping = 1e-6;  // small: the fit of all blocks is a close start
constexpr double kLeastShare = 0.05;   // of a step; ends the tries after s = 0.09

}  // namespace

NormalEquations prior(const LinearisedFit& fit) { return prior(fit.ranges, fit.coordinates, fit.prior_weight); }

std::vector<Eigen::VectorXd> steps_without(const LinearisedFit& fit, const std::vector<Fold>& folds) {
  if (fit.coordinates.size() == 0) return std::vector<Eigen::VectorXd>(folds.size());
  NormalEquations all = prior(fit);
  for (const NormalEquations& block : fit.blocks) all += block;
  std::vector<Eigen::VectorXd> steps;
  for (const Fold& fold : folds) {
    Eigen::MatrixXd information = all.information;
    Eigen::VectorXd gradient = all.gradient;
    for (const Eigen::Index b : fold.blocks) {
      information -= (1.0 - kKept) * fit.blocks[static_cast<std::size_t>(b)].information;
      gradient -= (1.0 - kKept) * fit.blocks[static_cast<std::size_t>(b)].gradient;
    }
    steps.push_back(bounded_step(information, gradient, fit.ranges, fit.coordinates, kFoldDamping));
  }
  return steps;
}

Eigen::VectorXd held_out_squares(const ResidualFunction& residuals, const Blocks& blocks, const LinearisedFit& fit,
                                 const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(fit, folds);
  Eigen::VectorXd at_all(static_cast<Eigen::Index>(fit.blocks.size()));
  for (Eigen::Index b = 0; b < at_all.size(); ++b) at_all[b] = fit.blocks[static_cast<std::size_t>(b)].squares;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(at_all.size());
  Eigen::VectorXd times = squares;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(at_all.size());
    for (const Eigen::Index b : folds[f].blocks) weight[b] = kKept;
    Eigen::VectorXd found = at_all;
    for (double share = 1.0; steps[f].size() > 0 && share > kLeastShare; share *= 0.3) {
      const Eigen::VectorXd there = fit.coordinates + share * steps[f];
      const Residuals reached = residuals(there);
      if (reached.empty()) continue;
      const Eigen::VectorXd by_block = blocks.squares(reached);
      const double change =
          weight.dot(by_block - at_all) + prior(fit.ranges, there, fit.prior_weight).squares - prior(fit).squares;
      if (!(change < 0.0)) continue;  // not lower, or NaN: the rollout diverged
      found = by_block;
      break;
    }
    for (const Eigen::Index b : folds[f].blocks) {
      squares[b] += found[b];
      times[b] += 1.0;
    }
  }
  return squares.cwiseQuotient(times.cwiseMax(1.0));
}

BlockComparison::BlockComparison(const Blocks& blocks, std::vector<Fold> folds, double floor_squares)
    : folds_(std::move(folds)),
      floor_squares_(floor_squares),
      samples_(Eigen::Map<const Eigen::VectorXd>(blocks.samples().data(), static_cast<Eigen::Index>(blocks.count()))) {}

Eigen::VectorXd BlockComparison::logarithms(const Eigen::VectorXd& squares) const {
  return (squares.array() / samples_.array().max(1.0) + floor_squares_ + 1e-300).log();
}

double BlockComparison::mean_log_square(const Eigen::VectorXd& squares) const { return logarithms(squares).mean(); }

Comparison BlockComparison::operator()(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const {
  Comparison found;
  found.gain = (first - second).sum() / samples_.sum();
  const Eigen::VectorXd difference = logarithms(first) - logarithms(second);
  const auto count = static_cast<double>(difference.size());
  found.log_gain = difference.mean();
  found.usual_gain = std::exp(mean_log_square(first)) - std::exp(mean_log_square(second));
  const double variance = (difference.array() - found.log_gain).square().sum() / std::max(1.0, count - 1.0);
  found.deviations = found.log_gain / std::sqrt(variance / count + 1e-300);
  double won = 0.0;
  for (const Fold& fold : folds_) {
    double sum = 0.0;
    for (const Eigen::Index b : fold.blocks) sum += difference[b];
    won += sum > 0.0 ? 1.0 : 0.0;
  }
  found.folds_won = folds_.empty() ? 0.0 : won / static_cast<double>(folds_.size());
  return found;
}

}  // namespace pmg::fitting
