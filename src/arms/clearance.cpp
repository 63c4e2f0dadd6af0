#include "arms/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pmg::arms {

namespace {

constexpr double kTiny = 1e-12;

Clearance between(const Eigen::Vector3d& mine, const Eigen::Vector3d& theirs, double radii_m,
                  const Eigen::Vector3d& otherwise) noexcept {
  const Eigen::Vector3d gap = mine - theirs;
  const double length = gap.norm();
  return {.distance_m = length - radii_m,
          .point = mine,
          .normal = length > kTiny ? Eigen::Vector3d(gap / length) : otherwise};
}

/// Of a direction that may be zero.
Eigen::Vector3d unit(const Eigen::Vector3d& v) noexcept {
  const double length = v.norm();
  return length > kTiny ? Eigen::Vector3d(v / length) : Eigen::Vector3d::UnitZ();
}

}  // namespace

Clearance clearance(const Capsule& capsule, const Capsule& other) noexcept {
  const Eigen::Vector3d d1 = capsule.b - capsule.a, d2 = other.b - other.a, r = capsule.a - other.a;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  double s = 0.0, t = 0.0;
  if (a <= kTiny) {
    t = e <= kTiny ? 0.0 : std::clamp(f / e, 0.0, 1.0);
  } else {
    const double c = d1.dot(r);
    if (e <= kTiny) {
      s = std::clamp(-c / a, 0.0, 1.0);
    } else {
      const double b = d1.dot(d2), denominator = a * e - b * b;
      s = denominator > kTiny ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
      t = (b * s + f) / e;
      if (t < 0.0) {
        t = 0.0;
        s = std::clamp(-c / a, 0.0, 1.0);
      } else if (t > 1.0) {
        t = 1.0;
        s = std::clamp((b - c) / a, 0.0, 1.0);
      }
    }
  }
  return between(capsule.a + s * d1, other.a + t * d2, capsule.radius_m + other.radius_m, unit(d1.cross(d2)));
}

Clearance clearance(const Capsule& capsule, const Box& box) noexcept {
  const Eigen::Vector3d a = box.pose.linear().transpose() * (capsule.a - box.pose.translation());
  const Eigen::Vector3d d = box.pose.linear().transpose() * (capsule.b - capsule.a);
  const auto beyond = [&](double t) -> Eigen::Vector3d {  // from the box's nearest point to the axis' point at t
    const Eigen::Vector3d p = a + t * d;
    return p - p.cwiseMax(-box.half_m).cwiseMin(box.half_m);
  };
  // Half the derivative of the squared distance is beyond(t) . d: linear between the places where the axis crosses a
  // face's plane, and it never falls.
  std::array<double, 8> places{0.0, 1.0};
  std::size_t count = 2;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < kTiny) continue;
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * box.half_m[axis] - a[axis]) / d[axis];
      if (!(t > 0.0 && t < 1.0)) continue;
      std::size_t at = count++;  // into its place in rising order, the end's 1 behind it
      for (; places[at - 1] > t; --at) places[at] = places[at - 1];
      places[at] = t;
    }
  }
  double t = 0.0, slope = beyond(0.0).dot(d);
  for (std::size_t i = 1; i < count && slope < 0.0; ++i) {
    const double next = beyond(places[i]).dot(d);
    t = next <= 0.0 ? places[i] : t + (places[i] - t) * slope / (slope - next);
    slope = next;
  }
  const Eigen::Vector3d mine = a + t * d, gap = beyond(t);
  Clearance found = between(mine, mine - gap, capsule.radius_m, unit(mine));
  found.point = box.pose * found.point;
  found.normal = box.pose.linear() * found.normal;
  return found;
}

}  // namespace pmg::arms
