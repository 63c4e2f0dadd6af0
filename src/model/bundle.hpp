// What a controller runs on, as one number: the SHA-256 of every file that decides its behaviour besides the program.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::model {

struct Bundle {
  /// Name and SHA-256 in hexadecimal, in the order of names. Names say what a file is to the robot, not where it lies:
  /// "robot.yaml", the URDF's name, "clips/...", "policies/...", "calibration/...".
  std::vector<std::pair<std::string, std::string>> files;
  /// Over the lines "SHA256  NAME\n" of files: what `sha256sum` prints in the robot's folder, hashed once more.
  std::string sha256;
};

/// Hashes robot.yaml, the URDF that it names, the files of this clip library, these policy files, and every file in
/// calibration/ beside robot.yaml. Throws ConfigError naming a file that can't be read.
Bundle bundle(const RobotModel& robot, const std::filesystem::path& clips,
              const std::vector<std::filesystem::path>& policies = {});

/// SHA-256 in hexadecimal over "NAME\nSIZE\nBYTES" of each of these files, in the order of their names. Throws
/// ConfigError naming a file that can't be read.
std::string files_sha256(std::vector<std::filesystem::path> files);

/// One number for the clips that a policy was trained on: files_sha256 of the library's files.
std::string clip_library_sha256(const std::filesystem::path& clips);

}  // namespace pmg::model
