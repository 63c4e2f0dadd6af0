#include "sil/shown_speed.hpp"

#include <fmt/format.h>

#include <cmath>

namespace pmg::sil {

void ShownSpeed::take(const PoseSample& pose) noexcept {
  if (pose.count < 7 || pose.time_s == time_s_) return;  // the base: position, and orientation w x y z
  const double w = pose.qpos[3], x = pose.qpos[4], y = pose.qpos[5], z = pose.qpos[6];
  const double yaw_rad = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  const double dt_s = pose.time_s - time_s_;
  if (time_s_ >= 0.0 && dt_s > 0.0 && dt_s < kPause_s) {
    const double vx = (pose.qpos[0] - x_m_) / dt_s, vy = (pose.qpos[1] - y_m_) / dt_s;
    const double share = 1.0 - std::exp(-dt_s / kSmooth_s);
    forwards_ += share * (std::cos(yaw_rad) * vx + std::sin(yaw_rad) * vy - forwards_);
    left_ += share * (-std::sin(yaw_rad) * vx + std::cos(yaw_rad) * vy - left_);
    turn_ += share * (std::remainder(yaw_rad - yaw_rad_, 2.0 * M_PI) / dt_s - turn_);
  } else {
    forwards_ = left_ = turn_ = 0.0;
  }
  time_s_ = pose.time_s;
  x_m_ = pose.qpos[0];
  y_m_ = pose.qpos[1];
  yaw_rad_ = yaw_rad;
}

std::string ShownSpeed::text() const {
  return fmt::format("{:+.2f} m/s forwards, {:+.2f} left, turn {:+.2f} rad/s", forwards_, left_, turn_);
}

}  // namespace pmg::sil
