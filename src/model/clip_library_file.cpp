#include "model/clip_library_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/config_reader.hpp"
#include "model/clip_table.hpp"
#include "model/command_inverse_file.hpp"
#include "model/standing_posture.hpp"
#include "pmg/blending.hpp"
#include "pmg/library_check.hpp"
#include "pmg/periodic_slopes.hpp"

namespace pmg::model {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kMaxSamples = 1024;
constexpr double kSamePosture_rad = 1e-6;  // far below an encoder's step, far above rounding

fs::path csv(const fs::path& directory, const std::string& name) { return directory / (name + ".csv"); }
fs::path yaml(const fs::path& directory, const std::string& name) { return directory / (name + ".yaml"); }

fs::path half_csv(const fs::path& directory, const std::string& name) { return csv(directory, half_gain_name(name)); }

double wrap(double phase) { return phase - std::floor(phase); }
double circular_distance(double a, double b) { return std::abs(a - b - std::round(a - b)); }

void check_limits(const ClipTable& table, const RobotModel& robot) {
  for (std::size_t row = 0; row < table.q.size(); ++row) {
    for (const Joint& joint : robot.joints) {
      const double angle = table.q[row][robot.joint_index.at(joint.name)];
      if (angle >= joint.lower_rad && angle <= joint.upper_rad) continue;
      files::raise(table.place(row), joint.name, fmt::format("is {} rad", angle),
                   fmt::format("{} to {}, its limits", joint.lower_rad, joint.upper_rad));
    }
  }
}

void read_mean_velocity(DynamicClip& clip, files::ConfigReader reader, const Corner& corner) {
  for (std::size_t i = 0; i < kVelocityChannels; ++i) {
    clip.mean_velocity[i] = reader.required<double>(kChannelNames[i]);
    if (corner.sign[i] != 0 && !(clip.mean_velocity[i] * corner.sign[i] > 0.0)) {
      reader.fail(kChannelNames[i], fmt::format("is {}", clip.mean_velocity[i]),
                  corner.sign[i] > 0 ? "a number above 0" : "a number below 0");
    }
  }
  reader.finish();
}

DynamicClip read_dynamic(const fs::path& directory, const std::string& name, const RobotModel& robot,
                         const Corner& corner) {
  DynamicClip clip;
  files::ConfigReader reader = files::ConfigReader::from_file(yaml(directory, name));
  reader.one_of("kind", {"dynamic"});
  reader.required<std::string>("source");
  clip.period_s = reader.required<double>("period_s", files::positive());
  files::ConfigReader contact = reader.map("contact");
  for (const Foot foot : {kLeft, kRight}) {
    files::ConfigReader side = contact.map(kFootNames[foot]);
    clip.contact_center[foot] = side.required<double>("center", files::in_range(0.0, std::nextafter(1.0, 0.0)));
    clip.duty_factor[foot] = side.required<double>("duty_factor", files::in_range(1e-3, 1.0));
    side.finish();
  }
  contact.finish();
  read_mean_velocity(clip, reader.map("mean_velocity"), corner);
  reader.finish();

  const ClipTable table = read_clip_table(csv(directory, name), robot.joint_index, false);
  if (table.q.size() < check::kMinSamples || table.q.size() > kMaxSamples) {
    files::raise({table.file.string()}, "", fmt::format("has {} samples", table.q.size()),
                 fmt::format("{} to {}", check::kMinSamples, kMaxSamples));
  }
  check_limits(table, robot);
  clip.q = table.q;
  clip.dq_dphi = periodic_spline_slopes(clip.q);
  return clip;
}

/// How a clip of one direction looks at half gain, if a file says so.
void read_half_gain(const fs::path& directory, const std::string& name, const RobotModel& robot, DynamicClip& clip) {
  if (!fs::exists(half_csv(directory, name))) return;
  const ClipTable table = read_clip_table(half_csv(directory, name), robot.joint_index, false);
  if (table.q.size() != clip.q.size()) {
    files::raise({table.file.string()}, "", fmt::format("has {} samples", table.q.size()),
                 fmt::format("{}, as {}.csv", clip.q.size(), name));
  }
  check_limits(table, robot);
  clip.half_q = table.q;
  clip.half_dq_dphi = periodic_spline_slopes(clip.half_q);
}

DynamicClip read_direction(const fs::path& directory, const std::string& name, const RobotModel& robot,
                           std::size_t direction) {
  DynamicClip clip = read_dynamic(directory, name, robot, kCornerTable[direction]);
  read_half_gain(directory, name, robot, clip);
  return clip;
}

/// (table, row of the first command that isn't negative) => the posture at command 0.
JointVector posture_at_zero(const ClipTable& table, std::size_t above) {
  if (table.command[above] == 0.0) return table.q[above];
  const double span = table.command[above] - table.command[above - 1];
  const double share = -table.command[above - 1] / span;
  return (1.0 - share) * table.q[above - 1] + share * table.q[above];
}

std::size_t row_of_zero(const ClipTable& table) {
  std::size_t above = 0;
  while (above < table.command.size() && table.command[above] < 0.0) ++above;
  if (above == table.command.size() || (above == 0 && table.command[0] > 0.0)) {
    files::raise({table.file.string()}, "command",
                 fmt::format("goes from {} to {}", table.command.front(), table.command.back()), "0 in its range");
  }
  return above;
}

/// At command 0 the posture must be the standing one. Otherwise the robot jumps when its clips are loaded.
void check_passes_stand(const ClipTable& table, const RobotModel& robot) {
  const std::size_t above = row_of_zero(table);
  const JointVector at_zero = posture_at_zero(table, above);
  for (const Joint& joint : robot.joints) {
    const double angle = at_zero[robot.joint_index.at(joint.name)];
    if (std::abs(angle - joint.stand_rad) > kSamePosture_rad) {
      files::raise(table.place(above), joint.name, fmt::format("is {} rad at command 0", angle),
                   fmt::format("{}, the standing posture", joint.stand_rad));
    }
  }
}

ClipTable read_postures(const fs::path& directory, const std::string& name, const RobotModel& robot) {
  ClipTable table = read_clip_table(csv(directory, name), robot.joint_index, true);
  if (table.q.size() < 2)
    files::raise({table.file.string()}, "", fmt::format("has {} rows", table.q.size()), "2 or more");
  for (std::size_t row = 1; row < table.command.size(); ++row) {
    if (!(table.command[row] > table.command[row - 1])) {
      files::raise(table.place(row), "command",
                   fmt::format("is {} after {}", table.command[row], table.command[row - 1]),
                   "strictly increasing ones");
    }
  }
  check_limits(table, robot);
  return table;
}

StaticClip read_static(const fs::path& directory, const std::string& name, const RobotModel& robot,
                       std::size_t channel) {
  files::ConfigReader reader = files::ConfigReader::from_file(yaml(directory, name));
  reader.one_of("kind", {"static"});
  reader.required<std::string>("source");
  reader.one_of("channel", {kChannelNames[channel]});
  reader.finish();

  const ClipTable table = read_postures(directory, name, robot);
  check_passes_stand(table, robot);
  return {table.command, table.q};
}

struct NamedClip {
  std::string name;
  PerFoot<double> contact_center;
};

/// Every clip that the generator may blend, mirrored ones included.
std::vector<NamedClip> blended_clips(const ClipLibrary& library) {
  std::vector<NamedClip> clips;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const std::optional<DynamicClip>& positive = library.positive[channel];
    const std::optional<DynamicClip>& negative = library.negative[channel];
    if (positive) clips.push_back({kPositiveNames[channel], positive->contact_center});
    if (negative) {
      clips.push_back({kNegativeNames[channel], negative->contact_center});
    } else if (positive && channel != kVx) {
      clips.push_back({kPositiveNames[channel],
                       {wrap(positive->contact_center[kRight] + 0.5), wrap(positive->contact_center[kLeft] + 0.5)}});
    }
  }
  for (const CornerClip& corner : library.corners) {
    clips.push_back({corner_clip_name({corner.sign}), corner.clip.contact_center});
  }
  return clips;
}

void check_contact_centers(const fs::path& directory, const ClipLibrary& library) {
  const std::vector<NamedClip> clips = blended_clips(library);
  for (const NamedClip& clip : clips) {
    for (const NamedClip& other : clips) {
      for (const Foot foot : {kLeft, kRight}) {
        if (circular_distance(clip.contact_center[foot], other.contact_center[foot]) <= check::kMaxContactCenterSpread)
          continue;
        const fs::path file = yaml(directory, clip.name);
        files::ConfigReader reader = files::ConfigReader::from_file(file);
        reader.map("contact")
            .map(kFootNames[foot])
            .fail("center",
                  fmt::format("is {}, and {} in {}", clip.contact_center[foot], other.contact_center[foot], other.name),
                  fmt::format("at most {} of a cycle between a library's clips", check::kMaxContactCenterSpread));
      }
    }
  }
}

void check_total(const fs::path& directory, const ClipLibrary& library) {
  double total_s = 0.0;
  const auto add = [&](const DynamicClip& clip, const std::string& name) {
    total_s += clip.period_s;
    if (total_s < kMaxDynamicTotal_s) return;
    files::ConfigReader::from_file(yaml(directory, name))
        .fail("period_s", fmt::format("brings the dynamic clips to {} s", total_s),
              fmt::format("less than {} s in total", kMaxDynamicTotal_s));
  };
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (library.positive[channel]) add(*library.positive[channel], kPositiveNames[channel]);
    if (library.negative[channel]) add(*library.negative[channel], kNegativeNames[channel]);
  }
  for (const CornerClip& corner : library.corners) add(corner.clip, corner_clip_name({corner.sign}));
}

fs::path library_yaml(const fs::path& directory) { return directory / "library.yaml"; }

VelocityScale read_velocity_scale(files::ConfigReader reader) {
  VelocityScale scale;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const std::vector<double> ends = reader.numbers(kChannelNames[channel], 2, files::positive());
    scale.negative[channel] = ends[0];
    scale.positive[channel] = ends[1];
  }
  reader.finish();
  return scale;
}

/// library.yaml: what holds for all clips together.
void read_rules(const fs::path& directory, ClipLibrary& library) {
  if (!fs::exists(library_yaml(directory))) return;
  files::ConfigReader reader = files::ConfigReader::from_file(library_yaml(directory));
  const std::string name = reader.one_of("blend", {kBlendNames.begin(), kBlendNames.end()});
  library.blend = static_cast<Blend>(std::ranges::find(kBlendNames, name) - kBlendNames.begin());
  if (reader.has("velocity_scale")) library.velocity_scale = read_velocity_scale(reader.map("velocity_scale"));
  reader.finish();
}

}  // namespace

JointVector standing_posture(const fs::path& directory, const RobotModel& robot) {
  const ClipTable table = read_postures(directory, kPostureNames.front(), robot);
  const std::size_t above = row_of_zero(table);
  const JointVector q = posture_at_zero(table, above);
  for (const Joint& joint : robot.joints) {
    const int i = robot.joint_index.at(joint.name);
    const int other = robot.mirror.partner[static_cast<std::size_t>(i)];
    const double mirrored = robot.mirror.sign[static_cast<std::size_t>(i)] * q[other];
    if (std::abs(q[i] - mirrored) <= kSamePosture_rad) continue;
    files::raise(table.place(above), joint.name, fmt::format("is {} rad at command 0", q[i]),
                 fmt::format("{}, the mirror image of {}", mirrored, robot.joint_index.name(other)));
  }
  return q;
}

std::string half_gain_name(const std::string& clip) { return clip + "_half"; }

std::string corner_clip_name(const Corner& corner) {
  std::string name;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (corner.sign[channel] == 0) continue;
    if (!name.empty()) name += '_';
    name += corner.sign[channel] > 0 ? kPositiveNames[channel] : kNegativeNames[channel];
  }
  return name;
}

std::vector<fs::path> clip_library_files(const fs::path& directory) {
  std::vector<fs::path> files;
  const auto add_all = [&](const auto& names) {
    for (const auto& name : names) {
      for (const fs::path& file : {csv(directory, name), yaml(directory, name)}) {
        if (fs::exists(file)) files.push_back(file);
      }
    }
  };
  add_all(kPositiveNames);
  add_all(kNegativeNames);
  for (const auto& names : {kPositiveNames, kNegativeNames}) {
    for (const char* name : names) {
      if (fs::exists(half_csv(directory, name))) files.push_back(half_csv(directory, name));
    }
  }
  add_all(kPostureNames);
  for (std::size_t c = kDirections; c < kCorners; ++c) {
    add_all(std::array{corner_clip_name(kCornerTable[c])});
  }
  for (const fs::path& file : {command_inverse_file(directory), library_yaml(directory)}) {
    if (fs::exists(file)) files.push_back(file);
  }
  return files;
}

ClipLibrary load_clip_library(const fs::path& directory, const RobotModel& robot) {
  if (!fs::is_directory(directory)) files::raise({directory.string()}, "", "isn't a directory", "a directory of clips");
  ClipLibrary library;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    library.positive[channel] = read_direction(directory, kPositiveNames[channel], robot, direction_of(channel, false));
    const char* negative = kNegativeNames[channel];
    if (fs::exists(csv(directory, negative)) || fs::exists(yaml(directory, negative))) {
      library.negative[channel] = read_direction(directory, negative, robot, direction_of(channel, true));
    }
  }
  for (std::size_t c = kDirections; c < kCorners; ++c) {
    const std::string name = corner_clip_name(kCornerTable[c]);
    if (!fs::exists(csv(directory, name)) && !fs::exists(yaml(directory, name))) continue;
    library.corners.push_back({kCornerTable[c].sign, read_dynamic(directory, name, robot, kCornerTable[c])});
  }
  for (std::size_t i = 0; i < library.posture.size(); ++i) {
    library.posture[i] = read_static(directory, kPostureNames[i], robot, kVelocityChannels + i);
  }
  read_rules(directory, library);
  if (fs::exists(command_inverse_file(directory))) library.inverse = read_command_inverse(directory);
  library.q_stand = robot.q_stand();
  library.q_lower = robot.q_lower();
  library.q_upper = robot.q_upper();
  library.mirror = robot.mirror;
  check_contact_centers(directory, library);
  check_total(directory, library);
  return library;
}

}  // namespace pmg::model
