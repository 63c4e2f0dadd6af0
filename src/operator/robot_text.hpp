// A robot's state as text for people and as JSON for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "operator/robot_board.hpp"

namespace pmg::ops {

/// The text shows a controller as gone after this time without a status.
inline constexpr double kGone_s = 1.0;

/// One line without a line break: "z1     walk   gamepad  vx 0.40 ... tick 180 us".
std::string one_line(const RobotNews& news, double silence_s);

/// The limits in force at this moment.
std::string limits_text(const RobotNews& news);

/// All about one robot, in several lines.
std::vector<std::string> screen(const RobotNews& news, double silence_s);

/// The same as JSON; keys of messages that have not arrived are absent.
nlohmann::ordered_json news_json(const RobotNews& news, double silence_s);

}  // namespace pmg::ops
