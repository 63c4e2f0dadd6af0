// What a controller made of a command that it can't follow as asked, and why, in words.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "operator/robot_board.hpp"
#include "pmg/command.hpp"

namespace pmg::ops {

/// (command that is sent, what the controller says of it) => one line, once it is known. From REFERENCE (what was
/// asked, what is realised, whether it was limited) and the ranges in ROBOT_INFO: nothing here knows a robot.
class TakenCommand {
 public:
  /// For so long the realised command must stand still: a ramp at the slowest rate moves it in every tick.
  static constexpr std::int64_t kSettled_ns = 150'000'000;

  explicit TakenCommand(const Command& asked) : asked_(asked) {}

  /// To be called after every link.receive() while the command is sent. news: of the robot that is driven. last: the
  /// command ends now, settled or not. The line, once; empty: nothing new, or taken as asked.
  std::string step(const RobotNews& news, std::int64_t now_ns, bool last = false);

 private:
  Command asked_;
  std::array<double, kChannels> realised_{};
  std::int64_t still_since_ns_ = -1;
  bool told_ = false;
};

}  // namespace pmg::ops
