// The text beside the keys, for a terminal and for a window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "operator/robot_board.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {

/// The command ranges in ROBOT_INFO's options; nothing if the options hold none.
std::optional<CommandLimits> command_limits(const pmg_msgs::robot_info_t& info);

/// Two columns for a window with a proportional font: labels and values, with equally many lines.
struct DrivingTable {
  std::string labels, values;
};
DrivingTable driving_table(const RobotDriver& driver, const RobotNews* news, double silence_s);

/// For a terminal, one line each: mode, requested and accepted command, limits in force, driving source. news: null
/// before the robot's first message.
std::vector<std::string> driving_lines(const RobotDriver& driver, const RobotNews* news, double silence_s);

/// The meaning of the keys, for a terminal and for a window.
std::vector<std::string> key_lines();
DrivingTable key_table();

/// (state, meaning of the keys, rows of the terminal) => what fits: the state loses its last lines first, then the keys
/// their first. What the robot waits for, at the top, and how to end, the last line, stay.
std::vector<std::string> fitted(std::vector<std::string> state, const std::vector<std::string>& keys, std::size_t rows);

}  // namespace pmg::ops
