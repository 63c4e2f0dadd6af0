#include "effects/other_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calib/joint_runs.hpp"
#include "effects/period.hpp"

namespace pmg::effects {

namespace {

constexpr double kLess = 0.75, kMore = 1.33;  // of a value
constexpr double kTurned_rad = 0.5;           // of a phase
constexpr int kRounds = 3;                    // from a parameter's other values
constexpr double kHopeless = 2.0;             // of the squares and the prior, by the Jacobian that is known
constexpr double kLower = 0.98;               // of them

/// Other values of a parameter to fit from, within its range; none of one that no fit moves.
std::vector<double> other_values(const NestedFit& fit, const NestedModel& model, const std::string& parameter) {
  const double value = calib::value(model.model, parameter);
  if (is_period(parameter)) {
    calib::JointModel without = model.model;
    calib::set(without, parameter, 0.0);
    std::vector<double> found = promising_periods_s(fit, without, parameter, kLess * value, kMore * value);
    found.insert(found.begin(), {kLess * value, kMore * value});
    return found;
  }
  const auto unknown = std::ranges::find(model.unknowns, parameter, &calib::Unknown::name);
  if (unknown == model.unknowns.end()) return {};
  if (calib::quantity(parameter) == model::Quantity::kPhase) {
    const double turn_rad = 2.0 * std::numbers::pi;
    return {std::remainder(value - kTurned_rad, turn_rad), std::remainder(value + kTurned_rad, turn_rad)};
  }
  std::vector<double> found;
  for (const double share : {kLess, kMore}) {
    const double other = std::clamp(share * value, unknown->lower, unknown->upper);
    if (other != value) found.push_back(other);
  }
  return found;
}

/// The fit from another value of a parameter; none where the others don't make up for it.
std::optional<NestedModel> fitted_from(const NestedFit& fit, const NestedModel& model, const RolloutJacobian& known,
                                       const std::string& parameter, double value, int most_iterations) {
  if (!(cost(fit.beside(model, parameter, value, &known)) < kHopeless * cost(model))) return std::nullopt;
  calib::JointModel start = fit.beside(model, parameter, value).model;
  if (is_period(parameter)) calib::set(start, parameter, best_period_s(fit, start, parameter));
  if (!(cost(fit.fit(start, model.unknowns, 0, nullptr, model.prior_weight)) < cost(model))) return std::nullopt;
  return fit.fit(start, model.unknowns, most_iterations, nullptr, model.prior_weight);
}

}  // namespace

NestedModel from_other_starts(const NestedFit& fit, NestedModel model, const std::vector<std::string>& parameters,
                              int most_iterations) {
  if (parameters.empty()) return model;
  const double first = cost(model);
  const RolloutJacobian known = fit.jacobian(model, fit.residuals(model.model));
  for (const std::string& parameter : parameters) {
    for (int round = 0; round < kRounds; ++round) {
      const double before = cost(model);
      for (const double value : other_values(fit, model, parameter)) {
        std::optional<NestedModel> other = fitted_from(fit, model, known, parameter, value, most_iterations);
        if (other && cost(*other) < kLower * cost(model)) model = *std::move(other);
      }
      if (!(cost(model) < before)) break;
    }
  }
  if (cost(model) < first && model.blocks.empty()) fit.linearise(model);
  return model;
}

NestedModel from_other_periods(const NestedFit& fit, const NestedModel& model, const std::vector<std::string>& periods,
                               int most_iterations) {
  if (periods.empty()) return model;
  const NestedFit few(calib::spread(fit.runs(), kRunsForPeriods), fit.threads());
  const NestedModel first = few.fit(model.model, model.unknowns, most_iterations, nullptr, model.prior_weight),
                    better = from_other_starts(few, first, periods, most_iterations);
  if (!(cost(better) < cost(first))) return model;
  NestedModel all = fit.fit(better.model, model.unknowns, most_iterations, nullptr, model.prior_weight);
  if (!(cost(all) < cost(model))) return model;
  if (all.blocks.empty()) fit.linearise(all);
  return all;
}

}  // namespace pmg::effects
