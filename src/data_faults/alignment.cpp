#include "data_faults/alignment.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::data_faults {

namespace {

constexpr std::size_t kFewestSamples = 30;
constexpr double kCoarse_s = 0.004;  // lags are tried so far apart first, then sample by sample around the best

struct Line {
  double factor = 0.0, correlation = 0.0;
  bool known = false;
};

/// Regression of y(k + lag) on x(k).
Line line(const std::vector<double>& x, const std::vector<double>& y, long lag) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  const long count = static_cast<long>(x.size());
  for (long k = std::max(0L, -lag); k < std::min(count, count - lag); ++k) {
    const double a = x[static_cast<std::size_t>(k)], b = y[static_cast<std::size_t>(k + lag)];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    n += 1.0, sx += a, sy += b, sxx += a * a, sxy += a * b, syy += b * b;
  }
  if (n < static_cast<double>(kFewestSamples)) return {};
  const double xx = sxx - sx * sx / n, yy = syy - sy * sy / n, xy = sxy - sx * sy / n;
  if (xx <= 1e-12 * sxx || yy <= 1e-12 * syy || xx <= 0.0 || yy <= 0.0) return {};
  return {xy / xx, xy / std::sqrt(xx * yy), true};
}

}  // namespace

Alignment align(const std::vector<double>& x, const std::vector<double>& y, double sample_s, double before_s,
                double after_s) {
  const long first = -std::lround(before_s / sample_s), last = std::lround(after_s / sample_s);
  const long coarse = std::max(1L, std::lround(kCoarse_s / sample_s));
  long best_lag = 0;
  Line best = line(x, y, 0);
  const Line unshifted = best;
  const auto try_lag = [&](long lag) {
    if (lag < first || lag > last) return;
    const Line here = line(x, y, lag);
    if (here.known && (!best.known || std::abs(here.correlation) > std::abs(best.correlation))) {
      best = here;
      best_lag = lag;
    }
  };
  for (long lag = first; lag <= last; lag += coarse) try_lag(lag);
  const long around = best_lag;
  for (long lag = around - coarse + 1; lag < around + coarse; ++lag) try_lag(lag);
  return {best.factor, best.correlation, unshifted.correlation, static_cast<double>(best_lag) * sample_s, best.known};
}

}  // namespace pmg::data_faults
