// Reads and writes clip libraries: a CSV with one column per joint (SI) and a YAML beside each
// (docs/reference/file-formats.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "pmg/blending.hpp"
#include "pmg/clip.hpp"

namespace pmg::model {

/// Largest difference of one foot's contact centre between the clips of a library [cycles].
inline constexpr double kMaxContactCenterSpread = 0.15;
inline constexpr double kMaxDynamicTotal_s = 10.0;  ///< upper bound of the sum of all dynamic clips' periods

/// Reads DIRECTORY/{forward,backward,lateral,turn}.{csv,yaml} (backward, lateral_right and turn_right optional) and
/// {bend,lean,squat}.{csv,yaml} for this robot. Also reads, if they exist, clips of several velocities
/// (corner_clip_name), inverse.csv, and library.yaml (the blending rule; gain without the file). Throws ConfigError
/// with file and line: wrong or missing joint columns, NaN, contact centres of one foot that differ by more than 0.15,
/// static commands that don't increase, dynamic clips of ten seconds or more in total, samples outside joint limits,
/// mean velocities in the wrong direction, a posture at command 0 that isn't the standing one.
ClipLibrary load_clip_library(const std::filesystem::path& directory, const RobotModel& robot);

/// Name of a clip of several velocities: the channels' names in turn, for example forward_turn or lateral_turn_right.
std::string corner_clip_name(const Corner& corner);

/// The existing files of the library.
std::vector<std::filesystem::path> clip_library_files(const std::filesystem::path& directory);

/// dq/dphi [rad per cycle] at N equidistant samples of a cycle: the slopes of the periodic cubic spline through them.
/// With the slopes m_k:  m_(k-1) + 4 m_k + m_(k+1) = 3 N (q_(k+1) - q_(k-1)).
std::vector<JointVector> periodic_spline_slopes(const std::vector<JointVector>& q);

/// Writes NAME.csv and NAME.yaml, so that load_clip_library reads back the same numbers. dq_dphi isn't written: it is
/// periodic_spline_slopes of q. Throws ConfigError when a file can't be written.
void write_dynamic_clip(const std::filesystem::path& directory, const std::string& name, const DynamicClip& clip,
                        const RobotModel& robot, const std::string& source);
void write_blend(const std::filesystem::path& directory, Blend blend);  ///< library.yaml
void write_static_clip(const std::filesystem::path& directory, const std::string& name, Channel channel,
                       const StaticClip& clip, const RobotModel& robot, const std::string& source);

}  // namespace pmg::model
