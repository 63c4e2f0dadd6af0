// (a log's ROBOT_INFO, this computer's files) => the controller that computes the log's ticks again, and how it differs
// from the one that ran.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "control/control_setup.hpp"
#include "logs/replay.hpp"
#include "pmg_msgs/robot_info_t.hpp"

namespace pmg::logs {

/// logged: the log's options (robot_info_t.options) as JSON. Robot and clips are those that the log names where they
/// still are, else this computer's robot of that name; replay's options go first.
control::ControlSetup replay_setup(const pmg_msgs::robot_info_t& info, const nlohmann::ordered_json& logged,
                                   const ReplayOptions& options);

/// One sentence for each file of the bundle that differs, by name.
void note_files(const pmg_msgs::robot_info_t& info, const control::LoadedControl& loaded,
                std::vector<std::string>& notes);

/// One sentence for each option whose default is not the log's value. The replay takes the log's value. Paths don't
/// count.
void note_options(const nlohmann::ordered_json& logged, const nlohmann::ordered_json& now,
                  std::vector<std::string>& notes);

/// The text under a key, or otherwise.
std::string option_text(const nlohmann::ordered_json& options, const char* key, const std::string& otherwise);

}  // namespace pmg::logs
