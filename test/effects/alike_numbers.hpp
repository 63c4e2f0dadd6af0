// A fit's last linearisation in which two numbers do nearly the same.
#pragma once

#include <cmath>

#include "effects/nested_fit.hpp"

namespace pmg::test {

/// (fit with two unknowns, blocks) => (the same with blocks whose residuals, of rms 1, each number moves by about one a
/// unit, the second by up to a tenth more or less than the first). The sum of the two is sure to about 0.1 for a
/// hundred blocks, each of them to about 2 at best.
inline effects::NestedModel with_alike_numbers(effects::NestedModel fit, std::size_t blocks) {
  fit.blocks.clear();
  for (std::size_t b = 0; b < blocks; ++b) {
    const auto place = static_cast<double>(b);
    const Eigen::Vector2d slope(1.0, 1.0 + 0.1 * std::cos(1.7 * place));
    const double residual = std::sqrt(2.0) * std::cos(2.4 * place + 1.0);
    fit.blocks.push_back({slope * slope.transpose(), slope * residual, residual * residual, 1.0});
  }
  return fit;
}

}  // namespace pmg::test
