#include "model/clip_library_writer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "files/config_error.hpp"
#include "model/clip_library_file.hpp"
#include "model/clip_table.hpp"
#include "model/command_inverse_file.hpp"

namespace pmg::model {
namespace {
namespace fs = std::filesystem;

void write_file(const fs::path& file, const std::string& text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) files::raise({file.string()}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "");
}

void write_clip(const fs::path& directory, const std::string& name, const std::string& csv, const std::string& yaml) {
  write_file(directory / (name + ".csv"), csv);
  write_file(directory / (name + ".yaml"), yaml);
}

/// text as a YAML double-quoted string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + '"';
}

}  // namespace

void require_writable(const fs::path& directory) {
  fs::path existing = fs::absolute(directory);
  std::error_code error;
  while (!fs::exists(existing, error) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  if (!fs::is_directory(existing, error) || access(existing.c_str(), W_OK | X_OK) != 0) {
    throw files::ConfigError(directory.string() +
                             ": can't be written to; expected a directory, or a place to make one in");
  }
}

void write_dynamic_clip(const fs::path& directory, const std::string& name, const DynamicClip& clip,
                        const RobotModel& robot, const std::string& source) {
  std::string text = fmt::format("kind: dynamic\nsource: {}\nperiod_s: {}\ncontact:\n", quoted(source), clip.period_s);
  for (const Foot foot : {kLeft, kRight}) {
    text += fmt::format("  {}: {{center: {}, duty_factor: {}}}\n", kFootNames[foot], clip.contact_center[foot],
                        clip.duty_factor[foot]);
  }
  text += "mean_velocity:\n";
  for (std::size_t i = 0; i < kVelocityChannels; ++i) {
    text += fmt::format("  {}: {}\n", kChannelNames[i], clip.mean_velocity[i]);
  }
  write_clip(directory, name, format_clip_table(robot.joint_index, {}, clip.q), text);
  if (!clip.half_q.empty()) {
    write_file(directory / (half_gain_name(name) + ".csv"), format_clip_table(robot.joint_index, {}, clip.half_q));
  }
}

void write_rules(const fs::path& directory, const ClipLibrary& library) {
  std::string text = fmt::format("blend: {}\n", kBlendNames[static_cast<std::size_t>(library.blend)]);
  if (library.velocity_scale) {
    text += "velocity_scale:\n";
    for (std::size_t i = 0; i < kVelocityChannels; ++i) {
      text += fmt::format("  {}: [{}, {}]\n", kChannelNames[i], library.velocity_scale->negative[i],
                          library.velocity_scale->positive[i]);
    }
  }
  write_file(directory / "library.yaml", text);
}

void write_static_clip(const fs::path& directory, const std::string& name, Channel channel, const StaticClip& clip,
                       const RobotModel& robot, const std::string& source) {
  write_clip(directory, name, format_clip_table(robot.joint_index, clip.command, clip.q),
             fmt::format("kind: static\nsource: {}\nchannel: {}\n", quoted(source), kChannelNames[channel]));
}

void write_clips(const fs::path& directory, const ClipLibrary& library, const RobotModel& robot,
                 const std::function<std::string(const std::string& name)>& source_of) {
  const auto dynamic = [&](const std::string& name, const std::optional<DynamicClip>& clip) {
    if (clip) write_dynamic_clip(directory, name, *clip, robot, source_of(name));
  };
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    dynamic(kPositiveNames[channel], library.positive[channel]);
    dynamic(kNegativeNames[channel], library.negative[channel]);
  }
  for (const CornerClip& corner : library.corners) dynamic(corner_clip_name({corner.sign}), corner.clip);
  for (std::size_t i = 0; i < library.posture.size(); ++i) {
    write_static_clip(directory, kPostureNames[i], static_cast<Channel>(kVelocityChannels + i), library.posture[i],
                      robot, source_of(kPostureNames[i]));
  }
}

UnfinishedLibrary::UnfinishedLibrary(const fs::path& library)
    : library_(library), made_(!fs::exists(library)), folder_(library / ".unfinished") {
  fs::remove_all(folder_);  // of a run that was killed
  fs::create_directories(folder_);
}

UnfinishedLibrary::~UnfinishedLibrary() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  if (made_) fs::remove(library_, ignored);  // if it is still empty
}

void UnfinishedLibrary::finish() const {
  if (!fs::exists(command_inverse_file(folder_))) fs::remove(command_inverse_file(library_));
  for (const auto& names : {kPositiveNames, kNegativeNames}) {
    for (const char* name : names) {
      const std::string half = half_gain_name(name) + ".csv";
      if (!fs::exists(folder_ / half)) fs::remove(library_ / half);
    }
  }
  for (const fs::path& file : clip_library_files(folder_)) fs::rename(file, library_ / file.filename());
}

}  // namespace pmg::model
