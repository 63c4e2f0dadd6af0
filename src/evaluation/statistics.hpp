// Means, shares and their intervals.
#pragma once

#include <cstdint>
#include <span>

namespace pmg::evaluation {

/// An estimate with its two-sided 95 % interval.
struct Estimate {
  double mean = 0.0, lower = 0.0, upper = 0.0;
  bool excludes_zero() const { return lower > 0.0 || upper < 0.0; }
};

/// Mean of independent samples with Student's t interval; both ends NaN for fewer than two samples, the mean too for
/// none.
Estimate mean_interval(std::span<const double> samples);

/// Of a - b, sample by sample: a[i] and b[i] were measured under the same circumstances. Throws std::invalid_argument
/// when they aren't equally many.
Estimate paired_difference(std::span<const double> a, std::span<const double> b);

/// Share of successes with Wilson's score interval (E. B. Wilson, JASA 22:209, 1927), which stays within [0, 1] and is
/// good for shares near its ends. [0, 1] about NaN for no trials.
Estimate share_interval(std::int64_t successes, std::int64_t trials);

}  // namespace pmg::evaluation
