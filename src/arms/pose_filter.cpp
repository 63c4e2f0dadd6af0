#include "arms/pose_filter.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::arms {

namespace {

constexpr double kArrived = 1e-6;  // [m], [rad]: below what any drive can show

}  // namespace

PoseFilter::PoseFilter(const PoseFilterOptions& options, double dt_s)
    : share_(1.0 - std::exp(-dt_s / options.time_constant_s)),
      step_m_(options.speed_m_s * dt_s),
      step_rad_(options.turn_rad_s * dt_s) {}

const PalmPose& PoseFilter::step(const PalmPose& wanted) noexcept {
  const Eigen::Vector3d way = wanted.p_m - pose_.p_m;
  const double length_m = way.norm();
  if (length_m < kArrived) {
    pose_.p_m = wanted.p_m;
  } else {
    pose_.p_m += std::min(share_, step_m_ / length_m) * way;
  }
  const Eigen::Vector3d turn = turn_between(pose_.R, wanted.R);
  const double angle_rad = turn.norm();
  if (angle_rad < kArrived) {
    pose_.R = wanted.R;
  } else {
    const double share = std::min(share_, step_rad_ / angle_rad);
    pose_.R = (Eigen::Quaterniond(Eigen::AngleAxisd(share * angle_rad, turn / angle_rad)) * pose_.R).normalized();
  }
  return pose_;
}

}  // namespace pmg::arms
