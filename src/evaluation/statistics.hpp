// Means, shares and their intervals.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pmg::evaluation {

/// An estimate with its two-sided 95 % interval.
struct Estimate {
  double mean = 0.0, lower = 0.0, upper = 0.0;
  bool excludes_zero() const { return lower > 0.0 || upper < 0.0; }
};

/// Mean of independent samples with Student's t interval: mean +- t_(0.975, n-1) s / sqrt(n). The ends are NaN for
/// fewer than two samples; for none the mean is NaN too.
Estimate mean_interval(std::span<const double> samples);

/// mean_interval of a[i] - b[i]; a[i] and b[i] were measured under the same circumstances. Throws std::invalid_argument
/// if the numbers of samples differ.
Estimate paired_difference(std::span<const double> a, std::span<const double> b);

/// Share p of successes with Wilson's score interval (E. B. Wilson, JASA 22:209, 1927), z = 1.96:
///   (p + z^2 / 2n +- z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n).
/// It stays within [0, 1] and is good for shares near its ends. Without trials: NaN with [0, 1].
Estimate share_interval(std::int64_t successes, std::int64_t trials);

/// A mean for people: "0.0640 +-0.0051", half of its interval; "0.0640" without one.
std::string mean_with_interval(const Estimate& mean);

/// A share for people: "80 [49, 94]" of 8 in 10; "-" without trials.
std::string percent_with_interval(const Estimate& share);

}  // namespace pmg::evaluation
