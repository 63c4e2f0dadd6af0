#include "fitting/folds.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::fitting {

namespace {

constexpr double kKept = 0.05;         // share of a fold's weight
constexpr double kFoldDamping = 1e-6;  // small: the fit of all blocks is a close start
constexpr double kLeastShare = 0.05;   // of a step; ends the tries after s = 0.09

/// The names of the folds' kinds, each once.
std::vector<std::string> kinds_of(const std::vector<Fold>& folds) {
  std::vector<std::string> kinds;
  for (const Fold& fold : folds) {
    if (std::find(kinds.begin(), kinds.end(), fold.name) == kinds.end()) kinds.push_back(fold.name);
  }
  return kinds;
}

/// Of each block, at the fit.
Eigen::VectorXd squares_at(const LinearisedFit& fit) {
  Eigen::VectorXd squares(static_cast<Eigen::Index>(fit.blocks.size()));
  for (Eigen::Index b = 0; b < squares.size(); ++b) squares[b] = fit.blocks[static_cast<std::size_t>(b)].squares;
  return squares;
}

/// Mean over its standard error.
double deviations(const Eigen::VectorXd& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = values.mean();
  const double variance = (values.array() - mean).square().sum() / std::max(1.0, count - 1.0);
  return mean / std::sqrt(variance / count + 1e-300);
}

}  // namespace

NormalEquations prior(const LinearisedFit& fit) { return prior(fit.ranges, fit.coordinates, fit.prior_weight); }

double cost(const LinearisedFit& fit) { return fit.squares + prior(fit).squares; }

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

HeldOut held_out_squares(const ResidualFunction& residuals, const Blocks& blocks, const LinearisedFit& fit,
                         const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(fit, folds);
  const Eigen::VectorXd at_all = squares_at(fit);
  const std::vector<std::string> kinds = kinds_of(folds);
  HeldOut squares{at_all.replicate(1, std::max<Eigen::Index>(1, std::ssize(kinds)))};
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
    const auto kind = std::find(kinds.begin(), kinds.end(), folds[f].name) - kinds.begin();
    for (const Eigen::Index b : folds[f].blocks) squares.of_kind(b, kind) = found[b];
  }
  return squares;
}

HeldOut foretold_held_out_squares(const LinearisedFit& fit, const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(fit, folds);
  const Eigen::VectorXd with_all = steps_without(fit, {Fold{}}).front();
  const std::vector<std::string> kinds = kinds_of(folds);
  HeldOut squares{squares_at(fit).replicate(1, std::max<Eigen::Index>(1, std::ssize(kinds)))};
  if (with_all.size() == 0) return squares;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const auto kind = std::find(kinds.begin(), kinds.end(), folds[f].name) - kinds.begin();
    for (const Eigen::Index b : folds[f].blocks) {
      const NormalEquations& block = fit.blocks[static_cast<std::size_t>(b)];
      const double change = block.squares_after(steps[f]) - block.squares_after(with_all);
      squares.of_kind(b, kind) = std::max(0.0, block.squares + change);
    }
  }
  return squares;
}

Eigen::VectorXd HeldOut::mean() const { return of_kind.rowwise().mean(); }

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
  found.log_gain = difference.mean();
  found.usual_gain = std::exp(mean_log_square(first)) - std::exp(mean_log_square(second));
  found.deviations = deviations(difference);
  double won = 0.0;
  for (const Fold& fold : folds_) {
    double sum = 0.0;
    for (const Eigen::Index b : fold.blocks) sum += difference[b];
    won += sum > 0.0 ? 1.0 : 0.0;
  }
  found.folds_won = folds_.empty() ? 0.0 : won / static_cast<double>(folds_.size());
  return found;
}

Comparison BlockComparison::operator()(const HeldOut& first, const HeldOut& second) const {
  Comparison found = (*this)(first.mean(), second.mean());
  const std::vector<std::string> kinds = kinds_of(folds_);
  for (Eigen::Index k = 0; k < std::ssize(kinds); ++k) {
    const Eigen::VectorXd one = first.of_kind.col(k), two = second.of_kind.col(k);
    found.of_kind.push_back({kinds[static_cast<std::size_t>(k)], deviations(logarithms(one) - logarithms(two)),
                             deviations((one - two).cwiseQuotient(samples_.cwiseMax(1.0)))});
  }
  return found;
}

}  // namespace pmg::fitting
