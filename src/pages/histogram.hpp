// Counting for histograms.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pmg::pages {

struct Bins {
  double from = 0.0, width = 1.0;
  std::vector<std::int64_t> counts;
  std::int64_t below = 0, above = 0;  ///< outside the bins
  std::int64_t not_finite = 0;

  std::int64_t total() const;  ///< all values: counts, those outside, and those that aren't finite
};

/// bins of equal width over [from, to]; the last one holds to as well.
Bins count(std::span<const double> values, double from, double to, int bins);

/// Nearest rank of the finite values, share in (0, 1]; 0 when there are none.
double percentile(std::span<const double> values, double share);

}  // namespace pmg::pages
