// The command that a controller follows in place of the requested one, and why, in words.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "operator/robot_board.hpp"
#include "pmg/command.hpp"

namespace pmg::ops {

/// Why the clips can't give these velocities together, from ROBOT_INFO's ranges and its command.velocities_together
/// (the sum of shares of the ranges that the clips reach); empty: they can, or ROBOT_INFO doesn't say. asked: kChannels
/// values.
std::string beyond_reach(const double* asked, const RobotNews& news);

/// (sent command, the controller's REFERENCE and ROBOT_INFO) => one line about the difference. REFERENCE holds the
/// requested and the realised command, ROBOT_INFO the ranges; so the text fits every robot.
class TakenCommand {
 public:
  /// The realised command counts as settled after this time without a change. The slowest ramp changes it in each tick.
  static constexpr std::int64_t kSettled_ns = 150'000'000;

  explicit TakenCommand(const Command& asked) : asked_(asked) {}

  /// Call after each link.receive() while sending the command. news: the driven robot. last: the command ends now,
  /// settled or not. Returns the line once; empty: no change, or the robot follows the requested command.
  std::string step(const RobotNews& news, std::int64_t now_ns, bool last = false);

 private:
  Command asked_;
  std::array<double, kChannels> realised_{};
  std::int64_t still_since_ns_ = -1;
  bool told_ = false;
};

}  // namespace pmg::ops
