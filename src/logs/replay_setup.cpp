#include "logs/replay_setup.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

namespace pmg::logs {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string option_text(const ordered_json& options, const char* key, const std::string& otherwise) {
  return options.contains(key) && options[key].is_string() ? options[key].get<std::string>() : otherwise;
}

control::ControlSetup replay_setup(const pmg_msgs::robot_info_t& info, const ordered_json& logged,
                                   const ReplayOptions& options) {
  control::ControlSetup setup;
  setup.robot = options.robot;
  setup.clips = options.clips;
  if (options.robot.empty()) {
    // The folder in the log if it still exists, else this computer's robot of that name.
    setup.robot = option_text(logged, "robot", info.model);
    const fs::path clips = option_text(logged, "clips", "");
    if (!fs::is_directory(setup.robot)) setup.robot = info.model;
    if (setup.clips.empty() && fs::is_directory(clips)) setup.clips = clips;
  }
  setup.policy = option_text(logged, "policy", info.policy);
  setup.blend = option_text(logged, "blend", setup.blend);
  return setup;
}

void note_files(const pmg_msgs::robot_info_t& info, const control::LoadedControl& loaded,
                std::vector<std::string>& notes) {
  if (info.bundle.empty()) {
    notes.push_back("the log doesn't say which files it ran with");
    return;
  }
  if (info.bundle == loaded.bundle) return;
  std::map<std::string, std::string> logged;
  for (std::size_t i = 0; i < info.bundle_file.size(); ++i) logged[info.bundle_file[i]] = info.bundle_sha256[i];
  for (const auto& [name, sha256] : loaded.files) {
    const auto found = logged.find(name);
    if (found == logged.end()) {
      notes.push_back(fmt::format("{} is here, but was not there when the log was made", name));
    } else if (found->second != sha256) {
      notes.push_back(fmt::format("{} is not the file that the log was made with", name));
    }
    if (found != logged.end()) logged.erase(found);
  }
  for (const auto& [name, sha256] : logged) notes.push_back(fmt::format("{} was there when the log was made", name));
}

void note_options(const ordered_json& logged, const ordered_json& now, std::vector<std::string>& notes) {
  if (!logged.is_object()) return;
  const ordered_json before = logged.flatten(), after = now.flatten();
  for (const auto& [key, value] : after.items()) {
    if (key == "/robot" || key == "/clips") continue;
    if (!before.contains(key)) {
      notes.push_back(fmt::format("option {} is {}; the log doesn't name it", key.substr(1), value.dump()));
    } else if (before[key] != value) {
      notes.push_back(
          fmt::format("option {} is the log's {}, not {}", key.substr(1), before[key].dump(), value.dump()));
    }
  }
}

}  // namespace pmg::logs
