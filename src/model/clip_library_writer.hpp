// Writes clip libraries, so that load_clip_library reads back the same numbers.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/blending.hpp"
#include "pmg/clip.hpp"

namespace pmg::model {

/// Throws ConfigError unless the directory, or the one that it would be made in, takes new files. Makes nothing.
void require_writable(const std::filesystem::path& directory);

/// Writes NAME.csv and NAME.yaml, and NAME_half.csv of a clip that has one. dq_dphi isn't written: it is
/// periodic_spline_slopes of q. Throws ConfigError when a file can't be written.
void write_dynamic_clip(const std::filesystem::path& directory, const std::string& name, const DynamicClip& clip,
                        const RobotModel& robot, const std::string& source);
void write_static_clip(const std::filesystem::path& directory, const std::string& name, Channel channel,
                       const StaticClip& clip, const RobotModel& robot, const std::string& source);
/// library.yaml: the blend, and the velocity scale if the library has its own.
void write_rules(const std::filesystem::path& directory, const ClipLibrary& library);

/// Writes every clip of a library, without its rules and inverse; source_of(name) says where a clip comes from.
void write_clips(const std::filesystem::path& directory, const ClipLibrary& library, const RobotModel& robot,
                 const std::function<std::string(const std::string& name)>& source_of);

/// A folder inside a library's, in which a new library is made and from which it moves when it is whole: an
/// interruption leaves the old clips with the inverse that belongs to them.
class UnfinishedLibrary {
 public:
  explicit UnfinishedLibrary(const std::filesystem::path& library);
  ~UnfinishedLibrary();
  UnfinishedLibrary(const UnfinishedLibrary&) = delete;
  UnfinishedLibrary& operator=(const UnfinishedLibrary&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// Moves the new files to their places. An old inverse or half-gain file without a new one goes: it doesn't belong to
  /// these clips.
  void finish() const;

 private:
  std::filesystem::path library_;
  bool made_;
  std::filesystem::path folder_;
};

}  // namespace pmg::model
