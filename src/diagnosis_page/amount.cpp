#include "diagnosis_page/amount.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>
#include <utility>

namespace pmg::diagnosis_page {

namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;
using evidence::Interval;
using model::Quantity;

constexpr double kDegrees = 180.0 / std::numbers::pi;
/// Of what was found: an interval that begins with less is read as "at most".
constexpr double kHardlyMore = 0.1;

std::string two_digits(double value) {
  return std::abs(value) < 100.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// A workshop's unit, and how a parameter becomes a number in it.
struct InWorkshop {
  std::string unit;
  std::function<double(double)> number = {};  ///< none: no workshop has such a unit
};

InWorkshop times(double factor, std::string unit) {
  return {std::move(unit), [factor](double value) { return factor * value; }};
}

bool is_scale(std::string_view name) { return name.ends_with("_scale"); }

/// Parameters without a unit are of several kinds.
InWorkshop of_a_share(std::string_view name) {
  if (is_scale(name))
    return {name == "sensor.angle_scale" ? "% in its readings" : "%",
            [](double value) { return 100.0 * (value - 1.0); }};
  if (name.starts_with("friction.load_")) return times(100.0, "% of the torque that it carries");
  return times(100.0, "%");
}

InWorkshop in_workshop(const std::string& name, bool linear) {
  switch (calib::quantity(name)) {
    case Quantity::kAngle:
    case Quantity::kQuantum:
      return linear ? times(1e3, "mm") : times(kDegrees, "degrees");
    case Quantity::kDelay:
    case Quantity::kPeriod:
    case Quantity::kLag:
      return times(1e3, "ms");
    case Quantity::kSpeed:
      return linear ? times(1e3, "mm/s") : times(kDegrees, "degrees/s");
    case Quantity::kTorque:
      return times(1.0, linear ? "N" : "Nm");
    case Quantity::kPower:
      return times(1.0, "W");
    case Quantity::kStiffness:
      return {linear ? "mm for each N" : "degrees for each Nm",
              [linear](double value) { return (linear ? 1e3 : kDegrees) / value; }};
    case Quantity::kFactor:
      return of_a_share(name);
    default:
      return {};
  }
}

/// A limit is "at most"; without it the simulation has none.
bool is_limit(const std::string& name) {
  return std::isinf(calib::value(calib::JointModel{}, name)) && calib::quantity(name) != Quantity::kStiffness;
}

/// True if the simulation has some of it already, and the number says more than a difference from that.
bool has_before(const Diagnosis& diagnosis, const std::string& name) {
  const double before = calib::value(diagnosis.before, name);
  return std::isfinite(before) && before != calib::value(calib::JointModel{}, name) && !is_scale(name);
}

/// (parameter that no workshop has a unit for) => ("1.5 times what the simulation has"), or nothing.
std::string in_proportion(const Diagnosis& diagnosis, const evidence::ParameterEstimate& parameter) {
  const double before = calib::value(diagnosis.before, parameter.name);
  if (!has_before(diagnosis, parameter.name) || before <= 0.0) return "";
  return fmt::format("{} times what the simulation has", two_digits(parameter.estimate.value / before));
}

}  // namespace

std::string size(const bench::Bench& bench, double value) {
  const InWorkshop shown = in_workshop("sensor.zero_offset_rad", bench.rig == bench::Rig::kLinear);
  return fmt::format("{} {}", two_digits(shown.number(value)), shown.unit);
}

std::string amount(const bench::Bench& bench, const Diagnosis& diagnosis, const Cause& cause) {
  if (cause.parameters.empty()) return "";
  const evidence::ParameterEstimate& first = cause.parameters.front();
  const InWorkshop shown = in_workshop(first.name, bench.rig == bench::Rig::kLinear);
  if (!shown.number) return in_proportion(diagnosis, first);
  const Interval& range = first.estimate;
  const double value = shown.number(range.value);
  if (!std::isfinite(value)) return "";
  const auto [low, high] = std::pair<double, double>(std::minmax(shown.number(range.low), shown.number(range.high)));
  std::string text = fmt::format("{}{}{} {}", is_limit(first.name) ? "at most " : "",
                                 is_scale(first.name) && value > 0.0 ? "+" : "", two_digits(value), shown.unit);
  const double without = shown.number(calib::value(diagnosis.before, first.name));
  const double nearer = value > without ? low : high;  // the end towards the simulation's value
  if ((nearer - without) / (value - without) < kHardlyMore)
    text += fmt::format(", at most {}", two_digits(value > without ? high : low));
  else if (std::isfinite(low) && std::isfinite(high) && two_digits(low) != two_digits(high))
    text += fmt::format(", between {} and {}", two_digits(low), two_digits(high));
  if (has_before(diagnosis, first.name)) text += fmt::format("; the simulation has {}", two_digits(without));
  return text;
}

}  // namespace pmg::diagnosis_page
