// Order statistics and quantiles of the normal distribution.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pmg::fitting {

/// Half-width of a two-sided 95 % interval of a normal distribution, in its standard deviations.
inline constexpr double kNormal95 = 1.95996398454;
/// Median of |x| for a standard normal x.
inline constexpr double kNormalMedianDeviation = 0.674490;

/// The value of this rank, counted from 0 for the smallest; 0 without values.
inline double value_at_rank(std::vector<double> values, std::size_t rank) {
  if (values.empty()) return 0.0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The value of rank floor(share * (n - 1)), not interpolated.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return value_at_rank(std::move(values), rank);
}

/// For an even number of values the larger of the middle two.
inline double median(std::vector<double> values) {
  const std::size_t rank = values.size() / 2;
  return value_at_rank(std::move(values), rank);
}

}  // namespace pmg::fitting
