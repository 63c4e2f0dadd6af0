// What every picture's axis is made of: the stretch of values that it shows, and ticks whose labels differ. page.js
// holds the same rules for charts.
#pragma once

#include <string>
#include <vector>

namespace pmg::pages {

inline constexpr double kLargestShown = 1e300;  ///< beyond it a range overflows; such values count as gaps

bool can_be_shown(double value);  ///< finite, and small enough to be laid out

/// The stretch of values that an axis shows; empty (from > to) until something is included.
struct Range {
  double from, to;

  static Range empty();
  void include(double value);  ///< leaves out what can't be shown
  bool is_empty() const { return !(from <= to); }
  double span() const { return to - from; }
};

/// What an axis shows of data within a range: margin, a share of the span, is added at both ends. Nothing at all is
/// shown as 0 to 1, a constant in the middle, zero of -1 to 1.
Range shown_range(const Range& data, double margin);

/// A round step, 1, 2 or 5 times a power of ten, that divides span into at most count parts.
double tick_step(double span, int count);

struct AxisTick {
  double value;
  std::string label;  ///< without unit; as many digits as tell it from its neighbours
};

/// At most count + 1 round values within the range, at least two.
std::vector<AxisTick> axis_ticks(const Range& range, int count);

/// Round values within a range of common logarithms: powers of ten, and what lies between where these are few.
std::vector<AxisTick> logarithmic_ticks(const Range& decades, int count);

}  // namespace pmg::pages
