#include "operator/stick_shape.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::ops {

std::array<double, 2> shaped(const StickShape& shape, double x, double y) noexcept {
  const double r = std::hypot(x, y);
  if (!(r > shape.dead_zone)) return {0.0, 0.0};
  const double t = std::min((r - shape.dead_zone) / (shape.full_at - shape.dead_zone), 1.0);
  const double s = (1.0 - shape.expo) * t + shape.expo * t * t * t;
  return {s * x / r, s * y / r};
}

}  // namespace pmg::ops
