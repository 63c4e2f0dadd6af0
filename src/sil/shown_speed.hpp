// How fast a simulated robot really moves, beside what its operator asks for.
#pragma once

#include <string>

#include "sil/simulated_robot.hpp"

namespace pmg::sil {

/// (poses of the pelvis) => forwards, left [m/s] and turn [rad/s] in the heading frame, low-passed with about half a
/// gait period, because the pelvis sways with each step. By the simulation's truth and time, so a late computer changes
/// nothing.
class ShownSpeed {
 public:
  static constexpr double kSmooth_s = 0.5;
  static constexpr double kPause_s = 0.5;  ///< poses that are farther apart begin anew

  void take(const PoseSample& pose) noexcept;
  double forwards_m_s() const noexcept { return forwards_; }
  double left_m_s() const noexcept { return left_; }
  double turn_rad_s() const noexcept { return turn_; }
  std::string text() const;  ///< "+0.38 m/s forwards, -0.01 left, turn +0.02 rad/s"

 private:
  double time_s_ = -1.0, x_m_ = 0.0, y_m_ = 0.0, yaw_rad_ = 0.0;
  double forwards_ = 0.0, left_ = 0.0, turn_ = 0.0;
};

}  // namespace pmg::sil
