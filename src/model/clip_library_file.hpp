// Reads and writes clip libraries: CSV with one column a joint by name (SI) and a YAML beside each (docs/file-formats.md).
#pragma once

#include <filesystem>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::model {

/// Reads DIRECTORY/{forward,backward,lateral,turn}.{csv,yaml} (backward, lateral_right and turn_right optional) and
/// {bend,lean,squat}.{csv,yaml} for this robot. Throws ConfigError with file and line: wrong or missing joint columns, NaN,
/// contact centres of one foot that differ by more than 0.15, static commands that don't increase, dynamic clips of ten
/// seconds or more in total, samples outside joint limits.
ClipLibrary load_clip_library(const std::filesystem::path& directory, const RobotModel& robot);

/// Writes NAME.csv and NAME.yaml into the directory, so that load_clip_library reads back the same numbers.
void write_dynamic_clip(const std::filesystem::path& directory, const std::string& name, const DynamicClip& clip,
                        const RobotModel& robot, const std::string& source);
void write_static_clip(const std::filesystem::path& directory, const std::string& name, Channel channel,
                       const StaticClip& clip, const RobotModel& robot, const std::string& source);

}  // namespace pmg::model
