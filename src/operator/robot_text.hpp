// A robot's news for people's eyes and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "operator/robot_board.hpp"

namespace pmg::ops {

/// A controller that was not heard for so long is shown as gone.
inline constexpr double kGone_s = 1.0;

/// "z1     walk   gamepad  vx 0.40 ... tick 180 us": all that one line holds. No line breaks.
std::string one_line(const RobotNews& news, double silence_s);

/// What the controller limits at this moment.
std::string limits_text(const RobotNews& news);

/// One robot at full length.
std::vector<std::string> screen(const RobotNews& news, double silence_s);

/// The same for machines; what was not heard is absent.
nlohmann::ordered_json news_json(const RobotNews& news, double silence_s);

}  // namespace pmg::ops
