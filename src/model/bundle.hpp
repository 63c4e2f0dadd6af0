// One SHA-256 over every file that decides a controller's behaviour, the program itself excepted.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::model {

struct Bundle {
  /// Name and SHA-256 in hexadecimal, sorted by name. A name says which role a file has, not its path: "robot.yaml",
  /// the URDF's name, "clips/...", "policies/...", "calibration/...".
  std::vector<std::pair<std::string, std::string>> files;
  /// SHA-256 over the lines "SHA256  NAME\n" of files, which is the output of `sha256sum` in the robot's folder.
  std::string sha256;
};

/// Hashes robot.yaml, its URDF, the files of this clip library (empty: none), these policy files, and every file in
/// calibration/ beside robot.yaml. Throws ConfigError naming a file that can't be read.
Bundle bundle(const RobotModel& robot, const std::filesystem::path& clips,
              const std::vector<std::filesystem::path>& policies = {});

/// SHA-256 in hexadecimal over "NAME\nSIZE\nBYTES" of each of these files, in the order of their names. Throws
/// ConfigError naming a file that can't be read.
std::string files_sha256(std::vector<std::filesystem::path> files);

/// files_sha256 of the library's files. A policy's metadata identifies its clips by this hash.
std::string clip_library_sha256(const std::filesystem::path& clips);

}  // namespace pmg::model
