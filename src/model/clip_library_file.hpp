// Reads clip libraries: a CSV with one column per joint (SI) and a YAML beside each (docs/reference/file-formats.md).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "pmg/blending.hpp"
#include "pmg/clip.hpp"

namespace pmg::model {

/// File names of a velocity channel's clips in its positive and its negative direction, and of a posture channel's
/// clip.
inline constexpr std::array<const char*, kVelocityChannels> kPositiveNames = {"forward", "lateral", "turn"};
inline constexpr std::array<const char*, kVelocityChannels> kNegativeNames = {"backward", "lateral_right",
                                                                              "turn_right"};
inline constexpr std::array<const char*, 3> kPostureNames = {"bend", "lean", "squat"};
inline constexpr std::array<const char*, 2> kFootNames = {"left", "right"};  ///< a clip's contacts

inline constexpr double kMaxDynamicTotal_s = 10.0;  ///< upper bound of the sum of all dynamic clips' periods

/// Reads DIRECTORY/{forward,backward,lateral,turn}.{csv,yaml} (backward, lateral_right and turn_right optional) and
/// {bend,lean,squat}.{csv,yaml} for this robot. Also reads, if they exist, clips of several velocities
/// (corner_clip_name), how clips of one direction look at half gain (half_gain_name), inverse.csv, and library.yaml
/// (the blending rule; gain without the file). Throws ConfigError with file and line: wrong or missing joint columns,
/// NaN, contact centres of one foot that differ by more than check::kMaxContactCenterSpread, static commands that don't
/// increase, dynamic clips of ten seconds or more in total, samples outside joint limits, mean velocities in the wrong
/// direction, a posture at command 0 that isn't the standing one.
ClipLibrary load_clip_library(const std::filesystem::path& directory, const RobotModel& robot);

/// Name of the file that says how a clip of one direction looks at half gain: forward_half. It isn't a motion of its
/// own, so its period doesn't count.
std::string half_gain_name(const std::string& clip);

/// Name of a clip of several velocities: the channels' names in turn, for example forward_turn or lateral_turn_right.
std::string corner_clip_name(const Corner& corner);

/// The existing files of the library.
std::vector<std::filesystem::path> clip_library_files(const std::filesystem::path& directory);

}  // namespace pmg::model
