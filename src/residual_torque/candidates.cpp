#include "residual_torque/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "residual_torque/repeat.hpp"

namespace pmg::residual_torque {

namespace {

using model::ResidualActs;
using model::ResidualAxis;
using model::ResidualQuantity;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// An axis, and the width of its bend or the lag of its change.
struct Axis {
  ResidualAxis axis;
  std::size_t variant = 0;
};

std::optional<Axis> axis_over(ResidualQuantity quantity, std::size_t variant, const MissingTorque& missing) {
  double low = 1e300, high = -1e300;
  for (const MissingRun& run : missing.runs) {
    const Eigen::VectorXd& values = run.values(quantity, variant);
    low = std::min(low, values.minCoeff());
    high = std::max(high, values.maxCoeff());
  }
  if (!(high - low > 1e-6 * (std::abs(low) + std::abs(high)))) return std::nullopt;
  const bool turns = quantity == ResidualQuantity::kPosition && high - low >= kTurn_rad;
  const double lag_s = quantity == ResidualQuantity::kCommandChange ? kLags_s[variant] : 0.0;
  return Axis{{quantity, low, turns ? low + kTurn_rad : high, 2, turns, lag_s}, variant};
}

std::vector<Axis> axes(const MissingTorque& missing, ResidualActs acts_as, std::optional<double> period_s) {
  const bool torque = acts_as == ResidualActs::kTorque;
  std::vector<Axis> found;
  for (const auto& [quantity, quantity_name] : model::residual_quantities()) {
    if (quantity == ResidualQuantity::kRest) continue;  // at rest nothing is missing: rest_start()
    const bool for_torque_alone = quantity == ResidualQuantity::kError || quantity == ResidualQuantity::kIntegral ||
                                  quantity == ResidualQuantity::kBend || quantity == ResidualQuantity::kCommandChange;
    if (torque ? quantity == ResidualQuantity::kSpeed : for_torque_alone) continue;
    if (quantity == ResidualQuantity::kTemperature && !missing.temperature_varies) continue;
    if (quantity == ResidualQuantity::kBend) {
      for (std::size_t w = 0; w < kWidths; ++w)
        found.push_back({{quantity, -missing.widths_rad[w], missing.widths_rad[w], 2, false}, w});
      continue;
    }
    for (std::size_t v = 0; v < (quantity == ResidualQuantity::kCommandChange ? kLags : 1); ++v) {
      if (const std::optional<Axis> axis = axis_over(quantity, v, missing)) found.push_back(*axis);
    }
    if (quantity == ResidualQuantity::kTime && period_s) found.push_back({{quantity, 0.0, *period_s, 2, true}, 0});
  }
  return found;
}

/// Column k: the k-th smooth function on the knots. Its half waves over the axis go to `half_waves`.
Eigen::MatrixXd waves(const ResidualAxis& axis, std::vector<double>& half_waves) {
  const Eigen::Index n = axis.knots;
  Eigen::MatrixXd found(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double half = axis.periodic ? 2.0 * std::ceil(0.5 * static_cast<double>(k)) : static_cast<double>(k);
    half_waves.push_back(half);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double place = (static_cast<double>(i) + (axis.periodic ? 0.0 : 0.5)) / static_cast<double>(n);
      const double phase = axis.periodic && k % 2 == 0 ? 0.0 : -0.5;
      found(i, k) = axis.periodic ? std::cos(std::numbers::pi * (half * place + (k == 0 ? 0.0 : phase)))
                                  : std::cos(std::numbers::pi * half * place);
    }
    found.col(k) /= found.col(k).norm();
  }
  return found;
}

void make_modes(Candidate& candidate, std::size_t most) {
  std::vector<double> first_waves, second_waves;
  const Eigen::MatrixXd first = waves(candidate.term.axes[0], first_waves);
  const Eigen::MatrixXd second = waves(candidate.term.axes[1], second_waves);
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t a = 0; a < first_waves.size(); ++a) {
    for (std::size_t b = 0; b < second_waves.size(); ++b) order.emplace_back(a, b);
  }
  const auto roughness = [&](const auto& at) { return std::hypot(first_waves[at.first], second_waves[at.second]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto& a, const auto& b) { return roughness(a) < roughness(b); });
  order.resize(std::min(order.size(), most));
  candidate.modes.resize(candidate.term.count(), std::ssize(order));
  candidate.half_waves.resize(std::ssize(order));
  for (Eigen::Index m = 0; m < candidate.modes.cols(); ++m) {
    const auto [a, b] = order[static_cast<std::size_t>(m)];
    candidate.half_waves[m] = roughness(order[static_cast<std::size_t>(m)]);
    for (Eigen::Index i = 0; i < first.rows(); ++i) {
      for (Eigen::Index j = 0; j < second.rows(); ++j)
        candidate.modes(i * second.rows() + j, m) =
            first(i, static_cast<Eigen::Index>(a)) * second(j, static_cast<Eigen::Index>(b));
    }
  }
}

/// The closest values that don't decrease, in least squares: neighbours that do are averaged (R. E. Barlow et al.,
/// Statistical Inference under Order Restrictions, 1972).
void make_increasing(std::vector<double>& values) {
  std::vector<std::pair<double, int>> levels;  // sum, number
  for (const double value : values) {
    levels.emplace_back(value, 1);
    while (levels.size() > 1) {
      const auto [sum, number] = levels.back();
      auto& [sum_before, number_before] = levels[levels.size() - 2];
      if (sum_before / number_before <= sum / number) break;
      sum_before += sum;
      number_before += number;
      levels.pop_back();
    }
  }
  auto at = values.begin();
  for (const auto& [sum, number] : levels) at = std::fill_n(at, number, sum / number);
}

/// The curve of a bristle, or of a lag: it decreases, is not below zero at the low end and not above zero at the high
/// end.
void make_falling(std::vector<double>& values) {
  std::reverse(values.begin(), values.end());
  make_increasing(values);
  std::reverse(values.begin(), values.end());
  values.front() = std::max(0.0, values.front());
  values.back() = std::min(0.0, values.back());
}

/// Orders the values along this axis, for each knot of the other. An order along the other axis stays: each step here
/// makes no value larger where all values are smaller.
void put_in_order(model::ResidualTerm& term, std::size_t axis) {
  const ResidualQuantity quantity = term.axes[axis].quantity;
  const bool falls = quantity == ResidualQuantity::kBend || quantity == ResidualQuantity::kCommandChange;
  const bool rises = quantity == ResidualQuantity::kIntegral || quantity == ResidualQuantity::kRest;
  if (term.axes[axis].knots == 1 || !(falls || rises)) return;
  const int stride = axis == 0 ? term.axes[1].knots : 1, lines = term.count() / term.axes[axis].knots;
  for (int line = 0; line < lines; ++line) {
    const int first = axis == 0 ? line : line * term.axes[1].knots;
    const auto value = [&](int k) -> double& { return term.values_Nm[static_cast<std::size_t>(first + k * stride)]; };
    std::vector<double> values;
    for (int k = 0; k < term.axes[axis].knots; ++k) values.push_back(value(k));
    if (falls)
      make_falling(values);
    else
      make_increasing(values);
    for (int k = 0; k < term.axes[axis].knots; ++k) value(k) = values[static_cast<std::size_t>(k)];
  }
}

std::string axis_text(const ResidualAxis& axis) { return std::string(name(axis.quantity)); }

}  // namespace

std::string text(const model::ResidualTerm& term) {
  std::string found = term.acts_as == ResidualActs::kTorque ? "torque over " : "friction over ";
  found += axis_text(term.axes[0]);
  if (term.axes[1].knots > 1) found += " and " + axis_text(term.axes[1]);
  return found;
}

std::vector<Candidate> candidates(const MissingTorque& missing, const Options& options) {
  const std::optional<double> period_s = repeats_each_s(missing, options);
  std::vector<Candidate> found;
  for (const ResidualActs acts_as : {ResidualActs::kTorque, ResidualActs::kFriction}) {
    const std::vector<Axis> all = axes(missing, acts_as, period_s);
    for (std::size_t a = 0; a < all.size(); ++a) {
      Candidate curve{{acts_as, {all[a].axis, {}}, {}}, {all[a].variant, 0}, {}, {}};
      curve.term.axes[0].knots = static_cast<int>(options.curve_knots);
      make_modes(curve, static_cast<std::size_t>(options.curve_knots));
      found.push_back(std::move(curve));
      for (std::size_t b = a + 1; b < all.size(); ++b) {
        if (all[a].axis.quantity == all[b].axis.quantity) continue;  // two widths or lags, or time and its phase
        Candidate map{{acts_as, {all[a].axis, all[b].axis}, {}}, {all[a].variant, all[b].variant}, {}, {}};
        for (ResidualAxis& axis : map.term.axes) axis.knots = static_cast<int>(options.map_knots);
        make_modes(map, static_cast<std::size_t>(options.map_modes));
        found.push_back(std::move(map));
      }
    }
  }
  return found;
}

model::ResidualTerm term_of(const Candidate& candidate, const Eigen::VectorXd& amplitudes, double bound_Nm) {
  model::ResidualTerm term = candidate.term;
  const Eigen::VectorXd values = candidate.modes * amplitudes;
  std::copy(values.begin(), values.end(), term.values_Nm.begin());
  for (std::size_t axis = 0; axis < 2; ++axis) put_in_order(term, axis);
  for (double& value : term.values_Nm) value = std::clamp(value, -bound_Nm, bound_Nm);
  return term;
}

}  // namespace pmg::residual_torque
