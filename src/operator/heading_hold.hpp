// Keeps a simulated robot on its heading while its operator asks for no turn.
#pragma once

#include <cstdint>
#include <optional>

#include "operator/robot_board.hpp"
#include "pmg/command.hpp"

namespace pmg::ops {

/// A person who watches a robot turns it back when it drifts; this does it in a simulation. On hardware it is off: the
/// yaw of an IMU drifts, and no robot turns that nobody asked to turn.
class HeadingHold {
 public:
  static constexpr double kGain_per_s = 1.0;   ///< yaw rate for a radian off the heading
  static constexpr double kMost_rad_s = 0.2;   ///< so that a person's turn always wins
  static constexpr double kSmooth_s = 0.4;     ///< half a gait period: the pelvis sways with the steps
  static constexpr double kStep_rad_s = 0.02;  ///< the yaw rate changes by such steps, so that a command settles
  static constexpr std::int64_t kSettle_ns = 500'000'000;  ///< until a robot that was turned goes straight

  /// (the device's command, news of the robot) => (the command, with a yaw rate back to the heading that the robot had
  /// when it began to walk without a turn). The command as it is: for hardware, where a turn or no velocity is asked
  /// for, and where the heading isn't known.
  Command held(const Command& asked, const RobotNews* news, std::int64_t now_ns);

 private:
  std::optional<double> heading_rad_;
  double error_rad_ = 0.0, correction_rad_s_ = 0.0;
  std::int64_t turned_ns_ = 0, seen_ns_ = 0;
};

/// Of the IMU about the vertical, from an arbitrary zero [rad]. Nothing: not known.
std::optional<double> yaw_rad(const RobotNews& news);

}  // namespace pmg::ops
