#include "model/residual_torque.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace pmg::model {

namespace {

constexpr std::array kNames = {
    ResidualQuantityName{ResidualQuantity::kPosition, "position_rad"},
    ResidualQuantityName{ResidualQuantity::kSpeed, "speed_rad_s"},
    ResidualQuantityName{ResidualQuantity::kError, "error_rad"},
    ResidualQuantityName{ResidualQuantity::kDrive, "drive_Nm"},
    ResidualQuantityName{ResidualQuantity::kIntegral, "integral_Nm_s"},
    ResidualQuantityName{ResidualQuantity::kBend, "bend_rad"},
    ResidualQuantityName{ResidualQuantity::kRest, "rest_s"},
    ResidualQuantityName{ResidualQuantity::kTemperature, "temperature_C"},
    ResidualQuantityName{ResidualQuantity::kTime, "time_s"},
    ResidualQuantityName{ResidualQuantity::kCommandChange, "command_change_Nm"},
};

/// Between the knots lower and lower + 1; knots beyond the axis have the value 0.
struct Cell {
  int lower;
  double share;
};

Cell cell(const ResidualAxis& axis, double x) {
  if (axis.knots == 1 && !axis.periodic) return {0, 0.0};
  if (axis.periodic) x -= (axis.high - axis.low) * std::floor((x - axis.low) / (axis.high - axis.low));
  const double place = std::clamp((x - axis.low) / axis.spacing(), -1.0, static_cast<double>(axis.knots));
  const int lower = std::min(static_cast<int>(std::floor(place)), axis.knots - 1);
  return {lower, place - lower};
}

/// The knot's number, or -1 beyond the axis.
int knot(const ResidualAxis& axis, int k) {
  if (axis.periodic) return k % axis.knots;
  return k < axis.knots ? k : -1;
}

/// text: const char* or a function that makes it, called only where something is wrong: checks allocate nothing.
template <typename Text>
void expect(bool holds, const Text& text) {
  if (holds) return;
  if constexpr (std::is_invocable_v<Text>) {
    throw std::invalid_argument(text());
  } else {
    throw std::invalid_argument(text);
  }
}

constexpr double kRounding_Nm = 1e-9;

/// Whether the values along this axis, for each knot of the other, rise (or fall) all the way.
bool monotone(const ResidualTerm& term, std::size_t axis, bool rises) {
  const int stride = axis == 0 ? term.axes[1].knots : 1;
  for (int at = 0; at < term.count(); ++at) {
    const int k = axis == 0 ? at / stride : at % term.axes[1].knots;
    if (k + 1 == term.axes[axis].knots) continue;
    const double step_Nm =
        term.values_Nm[static_cast<std::size_t>(at + stride)] - term.values_Nm[static_cast<std::size_t>(at)];
    if (rises ? step_Nm < -kRounding_Nm : step_Nm > kRounding_Nm) return false;
  }
  return true;
}

void check_order(const ResidualTerm& term, std::size_t axis) {
  if (term.axes[axis].knots == 1 || term.acts_as == ResidualActs::kFriction) return;
  expect(
      term.axes[axis].quantity != ResidualQuantity::kBend || monotone(term, axis, false),
      "residual_torque: values that rise over bend_rad would drive the joint; bristles pull back the more they bend");
  expect(term.axes[axis].quantity != ResidualQuantity::kCommandChange || monotone(term, axis, false),
         "residual_torque: values that rise over command_change_Nm would act before the command does");
  expect(term.axes[axis].quantity != ResidualQuantity::kIntegral || monotone(term, axis, true),
         "residual_torque: values that fall over integral_Nm_s would push away from the command");
}

}  // namespace

std::span<const ResidualQuantityName> residual_quantities() { return kNames; }

std::string_view name(ResidualQuantity quantity) {
  return std::find_if(kNames.begin(), kNames.end(), [&](const auto& one) { return one.quantity == quantity; })->name;
}

double ResidualAxis::spacing() const {
  if (periodic) return (high - low) / knots;
  return knots > 1 ? (high - low) / (knots - 1) : 1.0;
}

/// v = sum over the four corners of (1 - s or s) (1 - t or t) value, s and t the shares along both axes.
ResidualValue ResidualTerm::at(double first, double second) const noexcept {
  const Cell a = cell(axes[0], first), b = cell(axes[1], second);
  const auto along = [&](int k) {
    const int row = knot(axes[0], k);
    if (row < 0) return 0.0;
    double sum = 0.0;
    for (const auto& [column_at, weight] : {std::pair{b.lower, 1.0 - b.share}, std::pair{b.lower + 1, b.share}}) {
      const int column = knot(axes[1], column_at);
      if (column >= 0) sum += weight * values_Nm[static_cast<std::size_t>(row * axes[1].knots + column)];
    }
    return sum;
  };
  const double lower = along(a.lower), upper = axes[0].knots > 1 ? along(a.lower + 1) : lower;
  const bool beyond = a.share == 0.0 && a.lower == -1;
  const double slope = beyond || a.share == 1.0 ? 0.0 : (upper - lower) / axes[0].spacing();
  return {lower + a.share * (upper - lower), slope};
}

std::array<double, ResidualTerm::kMostValues> ResidualTerm::weights(double first, double second) const noexcept {
  const Cell a = cell(axes[0], first), b = cell(axes[1], second);
  std::array<double, kMostValues> found{};
  for (const auto& [row_at, row_weight] : {std::pair{a.lower, 1.0 - a.share}, std::pair{a.lower + 1, a.share}}) {
    for (const auto& [column_at, weight] : {std::pair{b.lower, 1.0 - b.share}, std::pair{b.lower + 1, b.share}}) {
      const int row = knot(axes[0], row_at), column = knot(axes[1], column_at);
      if (row < 0 || column < 0) continue;
      found[static_cast<std::size_t>(row * axes[1].knots + column)] += row_weight * weight;
    }
  }
  return found;
}

void check(const ResidualTorque& torque) {
  expect(torque.count >= 0 && torque.count <= ResidualTorque::kMostTerms, "a residual torque has at most two terms");
  for (const ResidualTerm& term : torque.used()) {
    for (const ResidualAxis& axis : term.axes) {
      const auto quantity = [&axis] { return std::string(name(axis.quantity)); };
      expect(axis.knots >= 1, [&] { return "residual_torque: " + quantity() + " has no knots"; });
      expect((axis.knots == 1 && !axis.periodic) || axis.high > axis.low,
             [&] { return "residual_torque: the range of " + quantity() + " is empty"; });
      expect(axis.quantity == ResidualQuantity::kCommandChange ? axis.lag_s > 0.0 : axis.lag_s == 0.0, [&] {
        return "residual_torque: lag_s is above 0 for command_change_Nm, and for nothing else; it is " +
               std::to_string(axis.lag_s) + " for " + quantity();
      });
      expect(!axis.periodic || axis.quantity == ResidualQuantity::kPosition || axis.quantity == ResidualQuantity::kTime,
             [&] { return "residual_torque: " + quantity() + " can't be periodic; only position_rad and time_s can"; });
      expect(axis.knots == 1 || axis.quantity != ResidualQuantity::kSpeed || term.acts_as == ResidualActs::kFriction,
             "residual_torque: a torque over speed_rad_s could drive the joint; only friction may depend on it");
    }
    expect(term.axes[1].knots == 1 || term.axes[0].quantity != term.axes[1].quantity,
           [&] { return "residual_torque: both axes are over " + std::string(name(term.axes[0].quantity)); });
    expect(term.count() <= ResidualTerm::kMostValues, [] {
      return "residual_torque: a term has at most " + std::to_string(ResidualTerm::kMostValues) + " values";
    });
    for (std::size_t axis = 0; axis < term.axes.size(); ++axis) check_order(term, axis);
  }
}

}  // namespace pmg::model
