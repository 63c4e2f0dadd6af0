#include "gco/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::gco {

namespace {

// Well below the millimetre at which the ground residual is judged; well above the movement of a corner from one tick's
// rounding noise in q.
constexpr double kCornerScale_m = 0.3e-3;
constexpr double kFootScale_m = 0.5e-3;

}  // namespace

ContactPoint contact_point(const std::array<Eigen::Vector3d, 4>& sole_B, const Eigen::Matrix3d& R_HB) noexcept {
  const Eigen::Vector3d up_B = R_HB.row(2).transpose();
  std::array<double, 4> height_m;
  for (std::size_t i = 0; i < 4; ++i) height_m[i] = up_B.dot(sole_B[i]);
  ContactPoint point;
  point.lowest_corner_m = *std::min_element(height_m.begin(), height_m.end());
  double total = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = std::exp((point.lowest_corner_m - height_m[i]) / kCornerScale_m);
    total += share;
    point.p_BC += share * sole_B[i];
    point.height_m += share * height_m[i];
  }
  point.p_BC /= total;
  point.height_m /= total;
  return point;
}

PerFoot<double> height_shares(const PerFoot<double>& height_m, const PerFoot<double>& weight) noexcept {
  const bool left = weight[kLeft] > 0.0, right = weight[kRight] > 0.0;
  if (left != right) return {left ? 1.0 : 0.0, right ? 1.0 : 0.0};
  if (!left) return {0.5, 0.5};
  const double softmin_left = 1.0 / (1.0 + std::exp((height_m[kLeft] - height_m[kRight]) / kFootScale_m));
  return {softmin_left, 1.0 - softmin_left};
}

}  // namespace pmg::gco
