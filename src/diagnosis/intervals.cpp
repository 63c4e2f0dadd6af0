#include "diagnosis/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "fitting/covariance.hpp"
#include "fitting/statistics.hpp"

namespace pmg::diagnosis {

namespace {

constexpr int kResamples = 1000;

evidence::Interval percentiles(double value, const std::vector<double>& drawn) {
  return {value, fitting::quantile(drawn, 0.025), fitting::quantile(drawn, 0.975)};
}

}  // namespace

std::vector<evidence::Interval> parameter_intervals(const effects::NestedModel& model,
                                                    const std::vector<fitting::Fold>& folds, double noise_squares,
                                                    const JointDiagnosisOptions& options) {
  const Eigen::Index count = model.coordinates.size();
  const Eigen::MatrixXd information = fitting::information(model);
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < count; ++i) {
    const effects::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double value = u.value(model.coordinates[i]), edge = 1e-6 * (u.upper - u.lower);
    const bool inside = value > u.lower + edge && value < u.upper - edge;
    if (inside && information(i, i) > fitting::kUnseen_rad2) seen.push_back(i);
  }
  const auto [of, inverse, robust] = fitting::cluster_robust_covariance(model, seen);
  Eigen::MatrixXd covariance = robust;
  double squares = 0.0, samples = 0.0;
  for (const fitting::NormalEquations& block : model.blocks) squares += block.squares, samples += block.samples;
  covariance += options.form_of_squares * std::max(0.0, squares - samples * noise_squares) * inverse;
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool fitted = std::find(seen.begin(), seen.end(), i) != seen.end();
    if (fitted || !(information(i, i) > fitting::kUnseen_rad2)) continue;
    const effects::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double range = u.coordinate(u.upper) - u.coordinate(u.lower);
    if (u.upper - u.lower > options.widest_tolerance * u.upper)
      continue;  // an effect's parameter at its bound, not one known to a tolerance
    const Eigen::VectorXd pull = inverse * information(seen, i) * (range / std::sqrt(12.0));
    covariance += pull * pull.transpose();
  }
  const Eigen::VectorXd moved = fitting::jackknife_variance(model, folds);
  std::vector<evidence::Interval> found;
  for (Eigen::Index i = 0; i < count; ++i) {
    const effects::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double value = u.value(model.coordinates[i]);
    const auto place = std::find(seen.begin(), seen.end(), i);
    if (place == seen.end()) {
      const bool unseen = !(information(i, i) > fitting::kUnseen_rad2);
      found.push_back(unseen ? evidence::Interval{value, u.lower, u.upper} : evidence::Interval{value, value, value});
      continue;
    }
    const Eigen::Index s = place - seen.begin();
    const double deviation = fitting::kNormal95 * std::sqrt(std::max({0.0, covariance(s, s), moved[i]}));
    const double form = options.form_of_value * std::abs(value);
    const double low = u.value(model.coordinates[i] - deviation) - form;
    const double high = u.value(model.coordinates[i] + deviation) + form;
    found.push_back({value, std::max(u.lower, low), std::min(u.upper, high)});
  }
  return found;
}

HeldOutErrors held_out_errors(const effects::NestedFit& runs, const calib::JointModel& before,
                              const calib::JointModel& after, unsigned seed) {
  const fitting::BlockSums first = runs.blocks().absolutes(runs.residuals(before));
  const fitting::BlockSums second = runs.blocks().absolutes(runs.residuals(after));
  std::mt19937 random(seed);
  std::vector<double> drawn_before, drawn_after;
  const std::size_t count = first.samples.size();
  for (int i = 0; i < kResamples; ++i) {
    double samples = 0.0, sum_before = 0.0, sum_after = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t block = random() % count;
      samples += first.samples[block];
      sum_before += first.values[block];
      sum_after += second.values[block];
    }
    drawn_before.push_back(sum_before / std::max(1.0, samples));
    drawn_after.push_back(sum_after / std::max(1.0, samples));
  }
  return {percentiles(first.mean(), drawn_before), percentiles(second.mean(), drawn_after)};
}

}  // namespace pmg::diagnosis
