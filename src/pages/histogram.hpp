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

  std::int64_t total() const;  ///< number of all values: in the bins, outside, not finite
  void multiply(double each);  ///< each value counted stands for so many
};

/// Bins of equal width over [from, to]. The last bin includes `to`.
Bins count(std::span<const double> values, double from, double to, int bins);

/// Quantile of the finite values by nearest rank, share in (0, 1]; 0 without values.
double percentile(std::span<const double> values, double share);

}  // namespace pmg::pages
