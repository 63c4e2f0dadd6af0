#include "diagnosis/intervals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pmg::diagnosis {

namespace {

constexpr double kNormal95 = 1.96;
constexpr int kResamples = 1000;
// A difference in form is one observation, not one a block; it rarely points where a parameter would.
constexpr double kFormWeight = 0.01;
constexpr double kForm = 0.04;      // of the value: what two integrators of the same joint differ by
constexpr double kTolerance = 0.3;  // of the value: wider ranges are those of searches
constexpr double kUnseen_rad2 = 1e-18;

evidence::Interval percentiles(double value, std::vector<double> drawn) {
  std::sort(drawn.begin(), drawn.end());
  const auto at = [&](double share) {
    return drawn[static_cast<std::size_t>(share * static_cast<double>(drawn.size() - 1))];
  };
  return {value, at(0.025), at(0.975)};
}

/// Variances of the coordinates by leaving out a gain, a load or a trajectory at a time: of the kind that moves them
/// most. What a form isn't right in pulls groups apart, though the blocks of each agree.
Eigen::VectorXd jackknife(const NestedModel& model, const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(model, folds);
  Eigen::VectorXd most = Eigen::VectorXd::Zero(model.coordinates.size());
  for (std::size_t first = 0, last = 0; first < folds.size(); first = last) {
    while (last < folds.size() && folds[last].name == folds[first].name) ++last;
    const auto groups = static_cast<double>(last - first);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(most.size()), squares = mean;
    for (std::size_t f = first; f < last; ++f) mean += steps[f] / groups;
    for (std::size_t f = first; f < last; ++f) squares += (steps[f] - mean).cwiseAbs2();
    most = most.cwiseMax((groups - 1.0) / groups * squares);
  }
  return most;
}

}  // namespace

std::vector<evidence::Interval> parameter_intervals(const NestedModel& model, const std::vector<Fold>& folds,
                                                    double noise_squares) {
  const Eigen::Index count = model.coordinates.size();
  std::vector<Eigen::Index> seen;
  Eigen::MatrixXd information = prior(model).information, scatter = Eigen::MatrixXd::Zero(count, count);
  for (const BlockNormal& block : model.blocks) information += block.information;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double value = u.value(model.coordinates[i]), edge = 1e-6 * (u.upper - u.lower);
    const bool inside = value > u.lower + edge && value < u.upper - edge;
    if (inside && information(i, i) > kUnseen_rad2) seen.push_back(i);
  }
  for (const BlockNormal& block : model.blocks) scatter += block.gradient * block.gradient.transpose();
  const auto spare = static_cast<double>(model.blocks.size()) - static_cast<double>(seen.size());
  scatter *= static_cast<double>(model.blocks.size()) / std::max(1.0, spare);
  scatter += model.prior_weight * prior(model).information;
  const Eigen::MatrixXd inside = information(seen, seen);
  const Eigen::VectorXd weight = inside.diagonal().cwiseSqrt().cwiseInverse();
  const auto size = static_cast<Eigen::Index>(seen.size());
  const Eigen::MatrixXd scaled = weight.asDiagonal() * inside * weight.asDiagonal();
  const Eigen::MatrixXd inverse =
      weight.asDiagonal() *
      (scaled + 1e-9 * Eigen::MatrixXd::Identity(size, size)).ldlt().solve(Eigen::MatrixXd::Identity(size, size)) *
      weight.asDiagonal();
  Eigen::MatrixXd covariance = inverse * scatter(seen, seen) * inverse;
  double squares = 0.0, samples = 0.0;
  for (const BlockNormal& block : model.blocks) squares += block.squares, samples += block.samples;
  covariance += kFormWeight * std::max(0.0, squares - samples * noise_squares) * inverse;
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool fitted = std::find(seen.begin(), seen.end(), i) != seen.end();
    if (fitted || !(information(i, i) > kUnseen_rad2)) continue;
    const Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double range = u.coordinate(u.upper) - u.coordinate(u.lower);
    if (u.upper - u.lower > kTolerance * u.upper)
      continue;  // an effect at its limit, not a number known to a tolerance
    const Eigen::VectorXd pull = inverse * information(seen, i) * (range / std::sqrt(12.0));
    covariance += pull * pull.transpose();
  }
  const Eigen::VectorXd moved = jackknife(model, folds);
  std::vector<evidence::Interval> found;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double value = u.value(model.coordinates[i]);
    const auto place = std::find(seen.begin(), seen.end(), i);
    if (place == seen.end()) {
      const bool unseen = !(information(i, i) > kUnseen_rad2);
      found.push_back(unseen ? evidence::Interval{value, u.lower, u.upper} : evidence::Interval{value, value, value});
      continue;
    }
    const Eigen::Index s = place - seen.begin();
    const double deviation = kNormal95 * std::sqrt(std::max({0.0, covariance(s, s), moved[i]}));
    const double form = kForm * std::abs(value);
    const double low = u.value(model.coordinates[i] - deviation) - form;
    const double high = u.value(model.coordinates[i] + deviation) + form;
    found.push_back({value, std::max(u.lower, low), std::min(u.upper, high)});
  }
  return found;
}

HeldOutErrors held_out_errors(const NestedFit& runs, const calib::JointModel& before, const calib::JointModel& after,
                              unsigned seed) {
  const BlockErrors first = runs.absolutes_by_block(runs.misses(before));
  const BlockErrors second = runs.absolutes_by_block(runs.misses(after));
  std::mt19937 random(seed);
  std::vector<double> drawn_before, drawn_after;
  const std::size_t count = first.samples.size();
  for (int i = 0; i < kResamples; ++i) {
    double samples = 0.0, sum_before = 0.0, sum_after = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t block = random() % count;
      samples += first.samples[block];
      sum_before += first.absolutes[block];
      sum_after += second.absolutes[block];
    }
    drawn_before.push_back(sum_before / std::max(1.0, samples));
    drawn_after.push_back(sum_after / std::max(1.0, samples));
  }
  return {percentiles(first.mean(), drawn_before), percentiles(second.mean(), drawn_after)};
}

}  // namespace pmg::diagnosis
