// Radial dead zone and expo: what every stick, finger or displacement becomes before it commands anything.
#pragma once

#include <array>

namespace pmg::ops {

/// Radial dead zone and expo of one stick; r is its distance from the centre, in [0, 1].
struct StickShape {
  double dead_zone = 0.0;  ///< below it the stick is neutral
  double full_at = 1.0;    ///< from it on the stick is at its end: worn sticks don't reach 1
  double expo = 0.0;       ///< 0: linear; 1: cubic
};

/// (x, y) => (x, y) scaled by s(r) / r:
///   t = clamp((r - dead_zone) / (full_at - dead_zone), 0, 1),  s = (1 - expo) t + expo t^3.
std::array<double, 2> shaped(const StickShape& shape, double x, double y) noexcept;

}  // namespace pmg::ops
