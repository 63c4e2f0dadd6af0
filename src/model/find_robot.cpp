#include <fmt/format.h>

#include <algorithm>

#include "files/config_error.hpp"
#include "files/nearest_name.hpp"
#include "model/robot_model.hpp"

namespace pmg::model {
namespace fs = std::filesystem;
namespace {

/// Folders that contain robots: beside the running binary (bin/../share/pmg) and in the source tree.
std::vector<fs::path> robot_folders() {
  std::error_code error;
  const fs::path binary = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> folders;
  if (!error) folders.push_back(binary.parent_path().parent_path() / "share" / "pmg" / "robots");
  folders.push_back(fs::path(PMG_SOURCE_DIR) / "config" / "robots");
  return folders;
}

}  // namespace

std::filesystem::path find_robot(const std::string& name) {
  if (fs::is_directory(name)) return name;
  std::vector<std::string> known;
  for (const fs::path& folder : robot_folders()) {
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
