#include "effects/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "effects/integration_part.hpp"
#include "fitting/covariance.hpp"
#include "fitting/f_distribution.hpp"
#include "fitting/statistics.hpp"

namespace pmg::effects {

namespace {

constexpr int kResamples = 1000;
constexpr double kDamping = 1e-6;  // of a step from a minimum
constexpr int kIterations = 4;     // of all numbers, as many as beside one that is held
constexpr double kNearly = 1.2;
constexpr double kFurther[] = {4.0 / 3.0, 2.0, 3.0};  // of an interval's half

/// Coordinates that the runs show and that are inside their ranges.
std::vector<Eigen::Index> seen_inside(const NestedModel& model, const Eigen::MatrixXd& information) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < model.coordinates.size(); ++i) {
    const calib::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double value = u.value(model.coordinates[i]), edge = 1e-6 * (u.upper - u.lower);
    const bool inside = value > u.lower + edge && value < u.upper - edge;
    if (inside && information(i, i) > fitting::kUnseen_rad2) seen.push_back(i);
  }
  return seen;
}

/// Half-widths of 95 % intervals in deviations: Student's t with the effective number of blocks.
Eigen::VectorXd student_widths(const NestedModel& model, const Eigen::MatrixXd& information) {
  Eigen::VectorXd widths = Eigen::VectorXd::Constant(model.coordinates.size(), fitting::kNormal95);
  const fitting::Covariance covariance = fitting::cluster_robust_covariance(model, seen_inside(model, information));
  const Eigen::VectorXd freedom = fitting::effective_blocks(model, covariance);
  for (std::size_t s = 0; s < covariance.of.size(); ++s)
    widths[covariance.of[s]] = fitting::student95(freedom[static_cast<Eigen::Index>(s)]);
  return widths;
}

/// Deviation of a coordinate that ended at the edge of its range, were it free to move on from there.
double deviation_at_edge(const NestedModel& model, const Eigen::MatrixXd& information, Eigen::Index coordinate) {
  std::vector<Eigen::Index> seen = seen_inside(model, information);
  seen.push_back(coordinate);
  const Eigen::MatrixXd covariance = fitting::cluster_robust_covariance(model, seen).robust;
  const Eigen::Index last = std::ssize(seen) - 1;
  return std::sqrt(std::max(0.0, covariance(last, last)));
}

evidence::Interval percentiles(double value, const std::vector<double>& drawn) {
  return {value, fitting::quantile(drawn, 0.025), fitting::quantile(drawn, 0.975)};
}

/// Of the coordinates that the runs show and that are inside their ranges: cluster-robust, and the sum of three of
/// coordinate_deviations().
struct SumOfThree {
  fitting::Covariance robust;
  Eigen::MatrixXd sum;
};

SumOfThree sum_of_three(const NestedModel& model, double noise_squares, const IntervalOptions& options) {
  const Eigen::MatrixXd information = fitting::information(model);
  SumOfThree found{fitting::cluster_robust_covariance(model, seen_inside(model, information)), {}};
  const auto& [seen, inverse, robust] = found.robust;
  found.sum = robust;
  double squares = 0.0, samples = 0.0;
  for (const fitting::NormalEquations& block : model.blocks) squares += block.squares, samples += block.samples;
  found.sum += options.form_of_squares * std::max(0.0, squares - samples * noise_squares) * inverse;
  for (Eigen::Index i = 0; i < model.coordinates.size(); ++i) {
    const bool fitted = std::find(seen.begin(), seen.end(), i) != seen.end();
    if (fitted || !(information(i, i) > fitting::kUnseen_rad2)) continue;
    const calib::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double range = u.coordinate(u.upper) - u.coordinate(u.lower);
    if (u.upper - u.lower > options.widest_tolerance * u.upper)
      continue;  // an effect's parameter at its bound, not one known to a tolerance
    const Eigen::VectorXd pull = inverse * information(seen, i) * (range / std::sqrt(12.0));
    found.sum += pull * pull.transpose();
  }
  return found;
}

}  // namespace

Eigen::VectorXd coordinate_deviations(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                      double noise_squares, const IntervalOptions& options) {
  const SumOfThree known = sum_of_three(model, noise_squares, options);
  const Eigen::VectorXd moved = fitting::jackknife_variance(model, folds);
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(model.coordinates.size());
  for (Eigen::Index s = 0; s < std::ssize(known.robust.of); ++s) {
    const Eigen::Index i = known.robust.of[static_cast<std::size_t>(s)];
    deviations[i] = std::sqrt(std::max({0.0, known.sum(s, s), moved[i]}));
  }
  return deviations;
}

double chance_of(const NestedModel& model, const std::vector<Eigen::Index>& coordinates, const Eigen::VectorXd& at,
                 double noise_squares, const IntervalOptions& options) {
  const SumOfThree known = sum_of_three(model, noise_squares, options);
  const std::vector<Eigen::Index>& seen = known.robust.of;
  std::vector<Eigen::Index> of;  // places in the covariance
  std::vector<double> away;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto place = std::find(seen.begin(), seen.end(), coordinates[i]);
    if (place == seen.end()) continue;
    of.push_back(place - seen.begin());
    away.push_back(model.coordinates[coordinates[i]] - at[static_cast<Eigen::Index>(i)]);
  }
  if (of.empty()) return 1.0;
  const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(away.data(), std::ssize(away));
  const Eigen::VectorXd scaled = fitting::solved(known.sum(of, of), d);
  const Eigen::VectorXd freedom = fitting::effective_blocks(model, known.robust);
  const auto count = static_cast<double>(of.size());
  return fitting::f_tail(d.dot(scaled) / count, count, freedom(of).minCoeff());
}

std::vector<evidence::Interval> parameter_intervals(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                                    double noise_squares, const IntervalOptions& options) {
  const Eigen::VectorXd deviations = coordinate_deviations(model, folds, noise_squares, options);
  const Eigen::MatrixXd information = fitting::information(model);
  const Eigen::VectorXd widths = student_widths(model, information);
  std::vector<evidence::Interval> found;
  for (Eigen::Index i = 0; i < model.coordinates.size(); ++i) {
    const calib::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    const double x = model.coordinates[i], value = u.value(x);
    if (!(information(i, i) > fitting::kUnseen_rad2)) {
      found.push_back({value, u.lower, u.upper});
      continue;
    }
    const double deviation = deviations[i] > 0.0 ? deviations[i] : deviation_at_edge(model, information, i);
    const double shift = model.step_shift.size() > 0 ? model.step_shift[i] : 0.0;
    const double half = widths[i] * deviation;
    const double form = options.form_of_value * (value != 0.0 ? std::abs(value) : std::abs(u.typical));
    const double low = u.value(x + std::min(0.0, shift) - half) - form;
    const double high = u.value(x + std::max(0.0, shift) + half) + form;
    found.push_back({value, std::max(u.lower, low), std::min(u.upper, high)});
  }
  return found;
}

std::vector<evidence::Interval> told(std::vector<evidence::Interval> intervals, const NestedModel& model,
                                     const IntervalOptions& options) {
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    auto& [value, low, high] = intervals[i];
    const calib::Unknown& u = model.unknowns[i];
    low = std::max(std::min(u.lower, low), value - options.told_width * (value - low));
    high = std::min(std::max(u.upper, high), value + options.told_width * (high - value));
  }
  return intervals;
}

std::vector<evidence::Interval> reaching(const NestedFit& fit, const NestedModel& model,
                                         std::vector<evidence::Interval> intervals,
                                         const std::vector<std::string>& parameters, const IntervalOptions& options) {
  if (parameters.empty()) return intervals;
  const RolloutJacobian known = fit.jacobian(model, fit.residuals(model.model));
  const NestedModel here = fit.fit(model.model, model.unknowns, kIterations, &known, model.prior_weight);
  const double most = cost(here) * (1.0 + options.reach_squares / static_cast<double>(model.blocks.size()));
  // Where the known Jacobian doesn't tell, it is made anew.
  const auto below = [&](const std::string& parameter, double value) {
    const double quick = cost(fit.beside(model, parameter, value, &known));
    return quick < most || (quick < kNearly * most && cost(fit.beside(model, parameter, value)) < most);
  };
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const calib::Unknown& u = model.unknowns[i];
    if (std::find(parameters.begin(), parameters.end(), u.name) == parameters.end()) continue;
    const double value = intervals[i].value;
    for (double* const edge : {&intervals[i].low, &intervals[i].high}) {
      const double told = *edge;
      for (const double times : kFurther) {
        const double there = std::clamp(value + times * (told - value), u.lower, u.upper);
        if (there == *edge || !below(u.name, there)) break;
        *edge = there;
      }
    }
  }
  return intervals;
}

NestedModel with_wide_differences(const NestedFit& fit, NestedModel model, const std::vector<fitting::Fold>& folds,
                                  double noise_squares, const IntervalOptions& options) {
  for (int round = 0; round < static_cast<int>(options.widenings); ++round) {
    const Eigen::VectorXd deviations = coordinate_deviations(model, folds, noise_squares, options);
    bool wider = false;
    for (std::size_t i = 0; i < model.unknowns.size(); ++i) {
      const fitting::Coordinate& range = model.ranges[i];
      const calib::Unknown& u = model.unknowns[i];
      const auto place = static_cast<Eigen::Index>(i);
      // Jumps make a number look surer than it is; none is surer than its form.
      const double value = u.value(model.coordinates[place]);
      const double of_form = std::abs(u.coordinate(value + options.form_of_value * value) - u.coordinate(value));
      const double width =
          std::min(std::max(deviations[place], of_form), options.widest_difference * (range.upper - range.lower));
      if (width < options.wider * range.step) continue;
      model.unknowns[i].difference = width;
      wider = true;
    }
    if (!wider) break;
    model = fit.fit(model.model, model.unknowns, static_cast<int>(options.iterations), nullptr, model.prior_weight);
    fit.linearise(model);
  }
  return model;
}

Eigen::VectorXd step_shift(const bench::Bench& bench, const NestedFit& fit, const NestedModel& model) {
  const fitting::Residuals residuals = fit.residuals(model.model);
  const fitting::Residuals error = integration_residuals(bench, fit, model.model, residuals);
  if (error.empty() || model.coordinates.size() == 0) return {};
  const fitting::Jacobian slopes = fit.jacobian(model, residuals).of_run;
  fitting::NormalEquations sum = fitting::prior(model);
  sum.information += fitting::products(slopes, slopes);
  sum.gradient = -fitting::products(slopes, error);
  return fitting::bounded_step(sum.information, sum.gradient, model.ranges, model.coordinates, kDamping);
}

HeldOutErrors held_out_errors(const NestedFit& runs_before, const calib::JointModel& before,
                              const NestedFit& runs_after, const calib::JointModel& after, unsigned seed) {
  const fitting::BlockSums first = runs_before.blocks().absolutes(runs_before.residuals(before));
  const fitting::BlockSums second = runs_after.blocks().absolutes(runs_after.residuals(after));
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

}  // namespace pmg::effects
