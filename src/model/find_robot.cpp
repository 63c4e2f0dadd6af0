#include <fmt/format.h>

#include <algorithm>

#include "files/config_error.hpp"
#include "files/config_folders.hpp"
#include "files/nearest_name.hpp"
#include "model/robot_model.hpp"

namespace pmg::model {
namespace fs = std::filesystem;

std::filesystem::path find_robot(const std::string& name) {
  if (fs::is_directory(name)) return name;
  std::vector<std::string> known;
  for (const fs::path& folder : files::config_folders("robots")) {
    if (!name.empty() && fs::exists(folder / name / "robot.yaml")) return folder / name;
    if (!fs::is_directory(folder)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (fs::exists(entry.path() / "robot.yaml")) known.push_back(entry.path().filename().string());
    }
  }
  std::sort(known.begin(), known.end());
  throw files::ConfigError(
      fmt::format("robot '{}' is neither known nor a folder; {}", name, files::expected_name(name, known)));
}

}  // namespace pmg::model
