// Identity of a run, in every log and on the network (pmg_msgs::robot_info_t): robot, policy, backend, files, options.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pmg::recording {

struct RunInfo {
  std::string robot{};       ///< the controller's name; the model's unless two of a kind share a network
  std::int64_t session = 0;  ///< larger at every start (wall clock [ns]); 0 in lockstep, whose logs are reproducible
  std::string policy = "none";
  std::string backend = "sil";
  std::string options{};                                     ///< configuration in force, JSON
  std::string bundle{};                                      ///< SHA-256 over the files below
  std::vector<std::pair<std::string, std::string>> files{};  ///< path relative to the robot's folder, SHA-256
  bool realtime = false;                                     ///< every thread got the scheduling that it needs
  std::vector<std::string> refused{};                        ///< the real-time scheduling that the system refused
};

/// Where logs go on when their own folder can't be used any more: below the system's folder for temporary files.
std::filesystem::path other_log_folder(const RunInfo& run);

/// Version of this software, for logs and --version.
const char* software_version() noexcept;

}  // namespace pmg::recording
