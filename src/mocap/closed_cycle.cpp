#include <algorithm>
#include <cmath>

#include "mocap/gait_cycle.hpp"

namespace pmg::mocap {
namespace {

/// Value and speed of a curve at a time: the cubic (Catmull-Rom) through the four frames around it.
std::array<double, 2> value_and_speed(const std::vector<double>& curve, double rate_hz, double t_s) {
  const auto last = static_cast<std::ptrdiff_t>(curve.size()) - 1;
  const double at = std::clamp(t_s * rate_hz, 0.0, static_cast<double>(last));
  const auto i = std::min(static_cast<std::ptrdiff_t>(at), last - 1);
  const auto y = [&](std::ptrdiff_t k) {
    if (k < 0) return 2.0 * curve[0] - curve[1];
    if (k > last) return 2.0 * curve[static_cast<std::size_t>(last)] - curve[static_cast<std::size_t>(last - 1)];
    return curve[static_cast<std::size_t>(k)];
  };
  const double a = y(i - 1), b = y(i), c = y(i + 1), d = y(i + 2), t = at - static_cast<double>(i);
  const double k1 = 0.5 * (c - a), k2 = 0.5 * (2.0 * a - 5.0 * b + 4.0 * c - d), k3 = 0.5 * (3.0 * (b - c) + d - a);
  return {b + t * (k1 + t * (k2 + t * k3)), (k1 + t * (2.0 * k2 + 3.0 * t * k3)) * rate_hz};
}

}  // namespace

ClosedCycle close_cycle(const HumanAngles& angles, const GaitCycle& cycle, const SeamOptions& options) {
  ClosedCycle closed;
  closed.names = angles.names;
  closed.period_s = cycle.period_s();
  const double n = static_cast<double>(options.samples);
  for (const std::vector<double>& curve : angles.angle_rad) {
    std::vector<double>& out = closed.angle_rad.emplace_back();
    if (curve.size() < 2) {
      out.assign(options.samples, curve.empty() ? 0.0 : curve[0]);
      continue;
    }
    const auto [q0, v0] = value_and_speed(curve, angles.rate_hz, cycle.from_s);
    const auto [q1, v1] = value_and_speed(curve, angles.rate_hz, cycle.to_s);
    const double d = q1 - q0, e = v1 - v0;
    closed.seam_before_rad = std::max(closed.seam_before_rad, std::abs(d));
    closed.seam_before_rad_s = std::max(closed.seam_before_rad_s, std::abs(e));
    const auto fade = [&](double p) { return std::exp(-0.5 * p * p / (options.sigma_cycles * options.sigma_cycles)); };
    for (std::size_t k = 0; k < options.samples; ++k) {
      const double p = static_cast<double>(k) / n;
      const double recorded = value_and_speed(curve, angles.rate_hz, cycle.from_s + p * closed.period_s)[0];
      const double after = 0.5 * (d + e * closed.period_s * p) * fade(p);
      const double before = 0.5 * (-d + e * closed.period_s * (1.0 - p)) * fade(1.0 - p);
      closed.moved_rad = std::max(closed.moved_rad, std::abs(after + before));
      out.push_back(recorded + after + before);
    }
  }
  return closed;
}

SeamJump seam_jump(const std::vector<std::vector<double>>& angle_rad, double period_s) {
  SeamJump jump;
  for (const std::vector<double>& q : angle_rad) {
    const std::size_t n = q.size();
    if (n < 8) continue;
    const double dt_s = period_s / static_cast<double>(n);
    // Both sides at the phase 0: the first samples begin there, the last are carried on by one step.
    const double end = 4.0 * q[n - 1] - 6.0 * q[n - 2] + 4.0 * q[n - 3] - q[n - 4];
    const double speed_after = (-11.0 * q[0] + 18.0 * q[1] - 9.0 * q[2] + 2.0 * q[3]) / (6.0 * dt_s);
    const double speed_before = (26.0 * q[n - 1] - 57.0 * q[n - 2] + 42.0 * q[n - 3] - 11.0 * q[n - 4]) / (6.0 * dt_s);
    jump.angle_rad = std::max(jump.angle_rad, std::abs(end - q[0]));
    jump.speed_rad_s = std::max(jump.speed_rad_s, std::abs(speed_before - speed_after));
  }
  return jump;
}

}  // namespace pmg::mocap
