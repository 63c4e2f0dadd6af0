#include "pages/line_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "pages/axis.hpp"

namespace pmg::pages {

namespace {

constexpr double kNoPoint = std::numeric_limits<double>::quiet_NaN();

void push_gap(LineData& data, double x) {
  data.x.push_back(x);
  for (std::vector<double>& line : data.y) line.push_back(kNoPoint);
}

struct Extremes {
  double first = kNoPoint, second = kNoPoint;
};

/// The smallest and the largest finite value of [from, to), in their order of time.
Extremes extremes(std::span<const double> y, std::size_t from, std::size_t to) {
  std::size_t low = to, high = to;
  for (std::size_t i = from; i < to; ++i) {
    if (!std::isfinite(y[i])) continue;
    if (low == to || y[i] < y[low]) low = i;
    if (high == to || y[i] > y[high]) high = i;
  }
  if (low == to) return {};
  return {y[std::min(low, high)], y[std::max(low, high)]};
}

/// Reduces [from, to), which is one column.
void push_column(LineData& data, std::span<const double> x, const std::vector<std::span<const double>>& y,
                 std::size_t from, std::size_t to) {
  const bool single = to - from == 1;
  data.x.push_back(x[from]);
  if (!single) data.x.push_back(x[to - 1]);
  for (std::size_t line = 0; line < y.size(); ++line) {
    const Extremes pair = extremes(y[line], from, to);
    data.y[line].push_back(pair.first);
    if (!single) data.y[line].push_back(pair.second);
  }
}

/// decimate() of the points with a finite x.
LineData decimate_placed(std::span<const double> x, const std::vector<std::span<const double>>& y, std::size_t columns,
                         double longest_gap) {
  const auto placed = [&x](std::span<const double> values) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (can_be_shown(x[i])) kept.push_back(values[i]);
    }
    return kept;
  };
  std::vector<std::vector<double>> kept;
  for (const auto line : y) kept.push_back(placed(line));
  return decimate(placed(x), {kept.begin(), kept.end()}, columns, longest_gap);
}

}  // namespace

LineData decimate(std::span<const double> x, const std::vector<std::span<const double>>& y, std::size_t columns,
                  double longest_gap) {
  for (const auto line : y) {
    if (line.size() != x.size()) throw std::invalid_argument("a line needs one y for each x");
  }
  if (!std::ranges::all_of(x, can_be_shown)) return decimate_placed(x, y, columns, longest_gap);
  if (!std::ranges::is_sorted(x)) throw std::invalid_argument("a line's x must not decrease");
  LineData data;
  data.y.resize(y.size());
  const bool keep_all = x.size() <= 2 * columns;
  const double width = keep_all ? 0.0 : (x.back() - x.front()) / static_cast<double>(columns);
  const auto column = [&](std::size_t i) {
    return width > 0.0 ? std::min(std::floor((x[i] - x.front()) / width), static_cast<double>(columns - 1)) : 0.0;
  };
  for (std::size_t from = 0, to = 0; from < x.size(); from = to) {
    if (from > 0 && x[from] - x[from - 1] > longest_gap) push_gap(data, 0.5 * (x[from] + x[from - 1]));
    to = from + 1;
    while (!keep_all && to < x.size() && column(to) == column(from) && x[to] - x[to - 1] <= longest_gap) ++to;
    push_column(data, x, y, from, to);
  }
  return data;
}

std::string delta_json(const std::vector<double>& values, double resolution) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!can_be_shown(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) low = high = 0.0;
  const double range = high - low;
  // The step is never below the last bit of the values.
  const double finest = std::max({range / resolution, std::abs(low) * 1e-15, 1e-300});
  const double step = range > 0.0 ? std::pow(10.0, std::floor(std::log10(finest))) : 1.0;
  const double offset = range > 0.0 && std::abs(low / step) < 1e15 ? std::floor(low / step) * step : low;
  std::string text = fmt::format("{{\"o\":{},\"s\":{},\"v\":[", offset, step);
  std::int64_t last = 0;
  const char* comma = "";
  for (const double value : values) {
    if (can_be_shown(value)) {
      const std::int64_t steps = std::llround((value - offset) / step);
      fmt::format_to(std::back_inserter(text), "{}{}", comma, steps - last);
      last = steps;
    } else {
      text += comma;
      text += "null";
    }
    comma = ",";
  }
  return text + "]}";
}

}  // namespace pmg::pages
