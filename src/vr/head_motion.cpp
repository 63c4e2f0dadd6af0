#include "vr/head_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmg::vr {

namespace {

struct Tilt {
  double pitch_rad, roll_rad;
};

/// Of R = Rz(yaw) Ry(pitch) Rx(roll).
Tilt tilt_of(const Eigen::Quaterniond& R) noexcept {
  const Eigen::Vector3d up = R.conjugate() * Eigen::Vector3d::UnitZ();
  return {std::asin(std::clamp(-up.x(), -1.0, 1.0)), std::atan2(up.y(), up.z())};
}

double wrapped(double angle_rad) noexcept { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

double one(const ops::StickShape& shape, double value) noexcept { return ops::shaped(shape, value, 0.0)[0]; }

double beyond(double value, double dead) noexcept {
  return value > dead ? value - dead : value < -dead ? value + dead : 0.0;
}

}  // namespace

std::optional<Centre> centre_of(const Pose& head) noexcept {
  const auto yaw_rad = yaw_of(head.R);
  if (!yaw_rad) return std::nullopt;
  const Tilt tilt = tilt_of(head.R);
  return Centre{.p_m = head.p_m, .yaw_rad = *yaw_rad, .pitch_rad = tilt.pitch_rad, .roll_rad = tilt.roll_rad};
}

bool HeadAsks::neutral() const noexcept {
  return std::ranges::all_of(share, [](double value) { return value == 0.0; });
}

std::optional<HeadAsks> head_asks(const Centre& centre, const Pose& head) noexcept {
  const auto yaw_rad = yaw_of(head.R);
  if (!yaw_rad) return std::nullopt;
  const Eigen::Vector3d d_m = centre.in_heading(Eigen::Vector3d(head.p_m - centre.p_m));
  const Tilt tilt = tilt_of(head.R);
  const auto step = ops::shaped(kStep, d_m.x() / kReach_m, d_m.y() / kReach_m);
  HeadAsks asks;
  asks.share[kVx] = step[0];
  asks.share[kVy] = step[1];
  asks.share[kOmega] = one(kTurn, wrapped(*yaw_rad - centre.yaw_rad) / kTurn_rad);
  asks.share[kPitch] = one(kTilt, (tilt.pitch_rad - centre.pitch_rad) / kTilt_rad);
  asks.share[kRoll] = one(kTilt, wrapped(tilt.roll_rad - centre.roll_rad) / kTilt_rad);
  asks.share[kHeight] = beyond(d_m.z(), kHeightDead_m);
  return asks;
}

}  // namespace pmg::vr
