#include "operator/heading_hold.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pmg::ops {

std::optional<double> yaw_rad(const RobotNews& news) {
  if (!news.state || !news.upright) return std::nullopt;
  const double* q = news.state->orientation_WI;
  const Eigen::Quaterniond R_WI(q[0], q[1], q[2], q[3]);
  const Eigen::Map<const Eigen::Vector3d> up_I(news.upright->up_I.data());
  if (!(std::abs(R_WI.norm() - 1.0) < 1e-3) || !(up_I.norm() > 0.5)) return std::nullopt;
  const Eigen::Vector3d level_W = R_WI * up_I.unitOrthogonal();  // any direction that is level in an upright robot
  return std::atan2(level_W.y(), level_W.x());
}

Command HeadingHold::held(const Command& asked, const RobotNews* news, std::int64_t now_ns) {
  const bool walks = asked[kVx] != 0.0 || asked[kVy] != 0.0;
  if (asked[kOmega] != 0.0) turned_ns_ = now_ns;
  const bool simulated = news != nullptr && news->info && news->info->backend == "sil";
  const std::optional<double> yaw = simulated ? yaw_rad(*news) : std::nullopt;
  if (!walks || !yaw || now_ns - turned_ns_ < kSettle_ns) {
    heading_rad_.reset();
    return asked;
  }
  if (!heading_rad_) {
    heading_rad_ = yaw;
    error_rad_ = correction_rad_s_ = 0.0;
    seen_ns_ = now_ns;
  }
  const double dt_s = 1e-9 * static_cast<double>(now_ns - seen_ns_);
  seen_ns_ = now_ns;
  const double error_rad = std::remainder(*heading_rad_ - *yaw, 2.0 * M_PI);
  error_rad_ += (1.0 - std::exp(-dt_s / kSmooth_s)) * (error_rad - error_rad_);
  const double wanted = std::clamp(kGain_per_s * error_rad_, -kMost_rad_s, kMost_rad_s);
  if (std::abs(wanted - correction_rad_s_) > 0.75 * kStep_rad_s) {
    correction_rad_s_ = kStep_rad_s * std::round(wanted / kStep_rad_s);
  }
  Command command = asked;
  command[kOmega] = correction_rad_s_;
  return command;
}

}  // namespace pmg::ops
