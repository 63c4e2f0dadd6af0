#include "imu/at_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pmg::imu {

namespace {
constexpr double kGravity_m_s2 = 9.81, kGravityBand_m_s2 = 2.0;
constexpr double kUprightBand_rad = 20.0 * std::numbers::pi / 180.0;
}  // namespace

void check_at_rest(const MtiSample& sample, const std::string& who) {
  const double force_m_s2 = sample.acceleration_m_s2.norm();
  if (std::abs(force_m_s2 - kGravity_m_s2) > kGravityBand_m_s2) {
    throw std::runtime_error(fmt::format("{}: measures {:.1f} m/s^2; expected {:.1f} within {:.0f} of a robot at rest",
                                         who, force_m_s2, kGravity_m_s2, kGravityBand_m_s2));
  }
  const Eigen::Vector3d up_W = sample.orientation_WI * sample.acceleration_m_s2 / force_m_s2;
  const double off_rad = std::acos(std::clamp(up_W.z(), -1.0, 1.0));
  if (off_rad > kUprightBand_rad) {
    throw std::runtime_error(
        fmt::format("{}: its orientation is {:.0f} degrees off gravity; expected its world frame's z to point up "
                    "(ENU), and the robot at rest",
                    who, off_rad * 180.0 / std::numbers::pi));
  }
}

}  // namespace pmg::imu
