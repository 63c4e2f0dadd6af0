// Uniform periodic cubic B-spline over one gait cycle.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pmg::generator {

/// The four basis functions that are not zero at a phase, and their derivatives with respect to phase [1/cycle].
struct SplineBasis {
  std::array<std::size_t, 4> knot{};
  std::array<double, 4> value{};
  std::array<double, 4> slope{};
};

/// phase: any real number [cycles]. The function of knot i peaks at phase i / knots.
inline SplineBasis spline_basis(double phase, std::size_t knots) {
  const double n = static_cast<double>(knots);
  const double x = (phase - std::floor(phase)) * n;
  const auto first = static_cast<std::size_t>(x) % knots;
  const double t = x - std::floor(x);
  const double t2 = t * t;
  const double t3 = t2 * t;
  SplineBasis basis;
  for (std::size_t i = 0; i < 4; ++i) {
    basis.knot[i] = (first + knots - 1 + i) % knots;
  }
  basis.value = {(1.0 - 3.0 * t + 3.0 * t2 - t3) / 6.0, (4.0 - 6.0 * t2 + 3.0 * t3) / 6.0,
                 (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3) / 6.0, t3 / 6.0};
  basis.slope = {n * (-1.0 + 2.0 * t - t2) / 2.0, n * (-4.0 * t + 3.0 * t2) / 2.0, n * (1.0 + 2.0 * t - 3.0 * t2) / 2.0,
                 n * t2 / 2.0};
  return basis;
}

}  // namespace pmg::generator
