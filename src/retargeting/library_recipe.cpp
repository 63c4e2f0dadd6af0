#include "retargeting/library_recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "files/config_reader.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::retargeting {
namespace {
namespace fs = std::filesystem;

fs::path within(const fs::path& folder, const std::string& path) { return path.empty() ? fs::path() : folder / path; }

/// `auto`, or [first, one after the last].
std::optional<std::pair<double, double>> read_frames(files::ConfigReader& reader) {
  constexpr const char* kExpected = "auto, or [first frame, frame after the last]";
  std::string word;
  try {
    word = reader.required<std::string>("frames");
  } catch (const files::ConfigError&) {
    const std::vector<double> range = reader.numbers("frames", 2, files::non_negative());
    if (range[1] <= range[0]) reader.fail("frames", fmt::format("is [{}, {}]", range[0], range[1]), kExpected);
    return std::pair(range[0], range[1]);
  }
  if (word != "auto") reader.fail("frames", "is " + word, kExpected);
  return std::nullopt;
}

ClipRecipe read_clip(const fs::path& recordings, const std::string& name, Channel channel, double sign,
                     files::ConfigReader reader) {
  ClipRecipe clip;
  clip.name = name;
  clip.channel = channel;
  clip.sign = sign;
  clip.place = reader.place();
  clip.recording = within(recordings, reader.required<std::string>("recording"));
  clip.frames = read_frames(reader);
  clip.frames_place = reader.place("frames");
  clip.mirrored = reader.optional<bool>("mirrored", false);
  clip.force_plates = within(recordings, reader.optional<std::string>("force_plates", ""));
  clip.read.skeleton = within(recordings, reader.optional<std::string>("skeleton", ""));
  clip.read.rest_pose = within(recordings, reader.optional<std::string>("rest_pose", ""));
  if (reader.has("rate_hz")) clip.options.rate_hz = reader.required<double>("rate_hz", files::positive());
  if (reader.has("unit_m")) clip.options.unit_m = reader.required<double>("unit_m", files::positive());
  if (reader.has("up")) clip.options.up = reader.one_of("up", {"+x", "-x", "+y", "-y", "+z", "-z"});
  if (!fs::is_regular_file(clip.recording))
    reader.fail("recording", fmt::format("is {}, which doesn't exist", clip.recording.string()), "a motion file");
  reader.finish();
  return clip;
}

}  // namespace

LibraryRecipe read_library_recipe(const fs::path& file, const fs::path& recordings) {
  LibraryRecipe recipe;
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  recipe.source = reader.required<std::string>("source");
  // The only way so far: postures of recorded people aren't retargeted. The file says it, so that nobody is surprised.
  reader.one_of("postures", {"synthesised"});
  if (reader.has("names")) recipe.names = within(file.parent_path(), reader.required<std::string>("names"));
  if (reader.has("duty_factor"))
    recipe.duty_factor = reader.required<double>("duty_factor", files::in_range(0.51, 0.95));
  files::ConfigReader clips = reader.map("clips");
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    for (const double sign : {1.0, -1.0}) {
      const std::string name = sign > 0.0 ? model::kPositiveNames[channel] : model::kNegativeNames[channel];
      if (sign > 0.0 || clips.has(name))
        recipe.clips.push_back(read_clip(recordings.empty() ? file.parent_path() : recordings, name,
                                         static_cast<Channel>(channel), sign, clips.map(name)));
    }
  }
  clips.finish();
  reader.finish();
  return recipe;
}

}  // namespace pmg::retargeting
