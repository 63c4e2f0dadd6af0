#include "evaluation/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "fitting/statistics.hpp"

namespace pmg::evaluation {

namespace {
constexpr double kUpperTail = 0.975;  // of a two-sided 95 % interval
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
}  // namespace

Estimate mean_interval(std::span<const double> samples) {
  if (samples.empty()) return {kNaN, kNaN, kNaN};
  const auto n = static_cast<double>(samples.size());
  double mean = 0.0;
  for (const double sample : samples) mean += sample / n;
  if (samples.size() < 2) return {mean, kNaN, kNaN};
  double squares = 0.0;
  for (const double sample : samples) squares += (sample - mean) * (sample - mean);
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), kUpperTail);
  const double half_width = t * std::sqrt(squares / (n - 1.0) / n);
  return {mean, mean - half_width, mean + half_width};
}

Estimate paired_difference(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw std::invalid_argument("paired samples must be equally many");
  std::vector<double> differences(a.size());
  std::ranges::transform(a, b, differences.begin(), std::minus<>{});
  return mean_interval(differences);
}

Estimate share_interval(std::int64_t successes, std::int64_t trials) {
  if (trials <= 0) return {kNaN, 0.0, 1.0};
  const auto n = static_cast<double>(trials);
  const double share = static_cast<double>(successes) / n, z2 = fitting::kNormal95 * fitting::kNormal95;
  const double center = (share + 0.5 * z2 / n) / (1.0 + z2 / n);
  const double half_width =
      fitting::kNormal95 * std::sqrt(share * (1.0 - share) / n + 0.25 * z2 / (n * n)) / (1.0 + z2 / n);
  // With no or only successes the interval ends exactly at 0 or 1; rounding would miss it.
  return {share, successes == 0 ? 0.0 : center - half_width, successes == trials ? 1.0 : center + half_width};
}

std::string mean_with_interval(const Estimate& mean) {
  if (!std::isfinite(mean.upper)) return fmt::format("{:.4f}", mean.mean);
  return fmt::format("{:.4f} +-{:.4f}", mean.mean, mean.upper - mean.mean);
}

std::string percent_with_interval(const Estimate& share) {
  if (std::isnan(share.mean)) return "-";
  return fmt::format("{:.0f} [{:.0f}, {:.0f}]", 100.0 * share.mean, 100.0 * share.lower, 100.0 * share.upper);
}

}  // namespace pmg::evaluation
