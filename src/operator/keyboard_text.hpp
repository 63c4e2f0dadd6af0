// What is shown beside the keys: in a terminal and in a window alike.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "operator/keyboard_driver.hpp"
#include "operator/robot_board.hpp"

namespace pmg::ops {

/// The ranges of the configuration in force, as ROBOT_INFO's options name them; nothing when they don't.
std::optional<CommandLimits> command_limits(const pmg_msgs::robot_info_t& info);

/// Two columns for a window, whose letters are not all as wide: labels and what they stand for, as many lines in both.
struct DrivingTable {
  std::string labels, values;
};
DrivingTable driving_table(const KeyboardDriver& driver, const RobotNews* news, double silence_s);

/// For a terminal, one line each: mode, what is asked and taken, what was limited, who drives. news: null before the
/// robot was heard.
std::vector<std::string> driving_lines(const KeyboardDriver& driver, const RobotNews* news, double silence_s);

/// What the keys do: for a terminal, and for a window.
std::vector<std::string> key_lines();
DrivingTable key_table();

}  // namespace pmg::ops
