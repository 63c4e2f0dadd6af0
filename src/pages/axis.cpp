#include "pages/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::pages {

namespace {

constexpr double kFewestUlps = 65536.0;  // of a range; with fewer, rounding of ticks and values would be visible

/// Power of ten of a value's first digit. Products of a step miss round values by a last bit.
int exponent(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9)); }

/// 1.5e-7: as 1.5 times ten to the -7, without padding.
std::string scientific(double value, int last_digit) {
  if (value == 0.0) return "0";
  const int digits = std::clamp(exponent(value) - last_digit, 0, 16);
  const std::string text = fmt::format("{:.{}e}", value, digits);
  const std::size_t e = text.find('e');
  return fmt::format("{}e{}", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

/// Labels of multiples of a step whose only digit stands at ten to the last_digit.
std::vector<AxisTick> labelled(const std::vector<double>& values, int last_digit) {
  std::vector<AxisTick> fixed, exponential;
  std::size_t fixed_length = 0, exponential_length = 0;
  for (const double value : values) {
    // 309 digits: a double may have so many before or behind its point.
    fixed.push_back({value, fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, std::clamp(-last_digit, 0, 309))});
    exponential.push_back({value, scientific(value, last_digit)});
    fixed_length = std::max(fixed_length, fixed.back().label.size());
    exponential_length = std::max(exponential_length, exponential.back().label.size());
  }
  constexpr std::size_t kWorthIt = 3;  // characters that an exponent must save
  return exponential_length + kWorthIt < fixed_length ? exponential : fixed;
}

}  // namespace

bool can_be_shown(double value) { return std::abs(value) < kLargestShown; }

Range Range::empty() { return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}; }

void Range::include(double value) {
  if (!can_be_shown(value)) return;
  from = std::min(from, value);
  to = std::max(to, value);
}

Range shown_range(const Range& data, double margin) {
  if (data.is_empty()) return {0.0, 1.0};
  const double largest = std::max(std::abs(data.from), std::abs(data.to));
  // Denormal numbers have no digits left for ticks.
  if (largest < 1e-290) return {-1.0, 1.0};
  const double least =
      data.span() > 0.0 ? kFewestUlps * std::numeric_limits<double>::epsilon() * largest : 0.2 * largest;
  const double beyond = std::max(margin * data.span(), 0.5 * (least - data.span()));
  return {data.from - beyond, data.to + beyond};
}

double tick_step(double span, int count) {
  const double rough = span / count, decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= rough * (1.0 - 1e-9)) return factor * decade;
  }
  return 10.0 * decade;
}

std::vector<AxisTick> axis_ticks(const Range& range, int count) {
  std::vector<double> values;
  double step = tick_step(range.span(), count);
  // One tick alone shows no scale.
  while (std::floor(range.to / step + 1e-9) - std::ceil(range.from / step - 1e-9) < 1.0) {
    step = tick_step(range.span(), ++count);
  }
  const double first = std::ceil(range.from / step - 1e-9), last = std::floor(range.to / step + 1e-9);
  for (double k = first; k <= last && values.size() <= static_cast<std::size_t>(count); k += 1.0)
    values.push_back(k * step);
  return labelled(values, exponent(step));
}

std::vector<AxisTick> logarithmic_ticks(const Range& decades, int count) {
  const double first = std::ceil(decades.from - 1e-9), last = std::floor(decades.to + 1e-9);
  std::vector<AxisTick> ticks;
  const auto add = [&ticks](double value) {
    const int power = exponent(value);
    ticks.push_back(std::move(labelled({value}, power).front()));
  };
  if (last - first < 1.0) {
    // Below two powers of ten linear steps are clearer.
    return axis_ticks({std::pow(10.0, decades.from), std::pow(10.0, decades.to)}, count);
  }
  const bool between = 3.0 * (last - first + 1.0) <= count;
  const double stride = std::max(1.0, std::ceil((last - first) / count));
  for (double decade = first - 1.0; decade <= last; decade += between ? 1.0 : stride) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double at = decade + std::log10(factor);
      if (at < decades.from - 1e-9 || at > decades.to + 1e-9 || (factor > 1.0 && !between)) continue;
      add(std::pow(10.0, decade) * factor);
    }
  }
  return ticks;
}

}  // namespace pmg::pages
