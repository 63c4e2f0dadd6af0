// LIBRARY.yaml: which recording becomes which clip.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/recording.hpp"
#include "pmg/command.hpp"

namespace pmg::retargeting {

struct ClipRecipe {
  std::string name;  ///< forward, backward, lateral, lateral_right, turn or turn_right
  Channel channel = kVx;
  double sign = 1.0;  ///< of the velocity
  std::filesystem::path recording;
  std::optional<std::pair<double, double>> frames;  ///< first, and the one after the last; nullopt: auto
  bool mirrored = false;
  std::filesystem::path force_plates;  ///< beside the recording; empty: none
  mocap::ReadOptions read;
  mocap::RecordingOptions options;
  files::Place place, frames_place;
};

struct LibraryRecipe {
  std::string source;  ///< who recorded it, under which terms: stands in every clip
  std::optional<std::filesystem::path> names;
  std::optional<double> duty_factor;  ///< of all dynamic clips; nullopt: the median of the recorded cycles
  std::vector<ClipRecipe> clips;
};

/// Reads docs/reference/file-formats.md's LIBRARY.yaml. Paths in it count from its folder; those of recordings from
/// `recordings` if that is given. Throws files::ConfigError with file, line, key and what was expected.
LibraryRecipe read_library_recipe(const std::filesystem::path& file, const std::filesystem::path& recordings = {});

}  // namespace pmg::retargeting
