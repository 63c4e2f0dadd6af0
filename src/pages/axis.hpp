// A picture's axis: its range of values, and ticks with different labels. page.js has the same rules for charts.
#pragma once

#include <string>
#include <vector>

namespace pmg::pages {

inline constexpr double kLargestShown = 1e300;  ///< larger values would overflow a range; they count as gaps

bool can_be_shown(double value);  ///< finite and below kLargestShown

/// The range of values of an axis; empty (from > to) until it includes a value.
struct Range {
  double from, to;

  static Range empty();
  void include(double value);  ///< ignores values that can't be shown
  bool is_empty() const { return !(from <= to); }
  double span() const { return to - from; }
};

/// (range of the data) => range of the axis. Both ends get `margin`, a share of the span. Without data the axis shows 0
/// to 1, for zeros -1 to 1; a constant is in the middle.
Range shown_range(const Range& data, double margin);

/// A round step (1, 2 or 5 times a power of ten) that divides span into at most count parts.
double tick_step(double span, int count);

struct AxisTick {
  double value;
  std::string label;  ///< without unit, with enough digits to differ from its neighbours
};

/// At most count + 1 round values within the range, at least two.
std::vector<AxisTick> axis_ticks(const Range& range, int count);

/// Round values within a range of common logarithms: powers of ten, and values between them if those are few.
std::vector<AxisTick> logarithmic_ticks(const Range& decades, int count);

}  // namespace pmg::pages
