#include "fitting/f_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::fitting {

namespace {

/// Continued fraction of the incomplete beta function (M. Abramowitz, I. A. Stegun, 1964, 26.5.8), by Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr int kMost = 300;  // terms; a few dozen suffice below the mean
  constexpr double kTiny = 1e-300, kEnough = 1e-12;
  const auto whole = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1.0, d = 1.0 / whole(1.0 - (a + b) * x / (a + 1.0)), fraction = d;
  for (int m = 1; m <= kMost; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double factor = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 / whole(1.0 + term * d);
      c = whole(1.0 + term / c);
      factor = c * d;
      fraction *= factor;
    }
    if (std::abs(factor - 1.0) < kEnough) break;
  }
  return fraction;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                       : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

}  // namespace

double f_tail(double ratio, double above, double below) {
  if (!(above > 0.0) || !(below > 0.0) || !(ratio > 0.0)) return 1.0;
  return incomplete_beta(0.5 * below, 0.5 * above, below / (below + above * ratio));
}

double student95(double freedom) {
  if (!(freedom > 0.0)) return std::numeric_limits<double>::infinity();
  double low = 0.0, high = 1e3;  // of 1 degree of freedom it is 12.7
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (f_tail(middle * middle, 1.0, freedom) > 0.05 ? low : high) = middle;
  }
  return high;
}

}  // namespace pmg::fitting
