#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "files/bounded_file.hpp"
#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/unit_name.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace fs = std::filesystem;
namespace {

/// The ASF file of an AMC file: of the same name, or the only one of the folder, or as CMU names them (16_15.amc,
/// 16.asf).
fs::path asf_beside(const fs::path& amc) {
  fs::path same = amc;
  if (fs::exists(same.replace_extension(".asf"))) return same;
  const std::string stem = amc.stem().string();
  fs::path subject = amc.parent_path() / (stem.substr(0, stem.find('_')) + ".asf");
  if (fs::exists(subject)) return subject;
  fs::path only;
  int found = 0;
  std::error_code error;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(amc.has_parent_path() ? amc.parent_path() : ".", error)) {
    if (!same_word(entry.path().extension().string(), ".asf")) continue;
    only = entry.path();
    ++found;
  }
  if (found != 1) {
    files::raise({amc.string()}, "", "no ASF file belongs to it",
                 "--skeleton FILE, or an ASF file of the same name beside it");
  }
  return only;
}

std::string content(const fs::path& file) {
  return files::read_bounded_bytes(file, kLargestMotion_bytes, "a motion file");
}

/// Without UTF-8's mark in front, which programs on Windows write.
std::string text_of(const fs::path& file) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  std::string text = content(file);
  if (text.starts_with(kMark)) text.erase(0, kMark.size());
  return text;
}

}  // namespace

void expect_bounded_samples(const std::string& place, std::size_t frames, std::size_t points) {
  if (points > kMostPoints || frames > kMostSamples / std::max<std::size_t>(points, 1)) {
    files::raise({place}, "", fmt::format("has {} frames of {} points or more", frames, points),
                 fmt::format("{} points and {} samples of them at most: cut the recording", kMostPoints, kMostSamples));
  }
}

std::optional<double> unit_of_name(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, double>, 14> kUnits = {{{"m", 1.0},
                                                                           {"meters", 1.0},
                                                                           {"metres", 1.0},
                                                                           {"dm", 0.1},
                                                                           {"cm", 0.01},
                                                                           {"centimeters", 0.01},
                                                                           {"mm", 0.001},
                                                                           {"millimeters", 0.001},
                                                                           {"millimetres", 0.001},
                                                                           {"in", 0.0254},
                                                                           {"inch", 0.0254},
                                                                           {"inches", 0.0254},
                                                                           {"ft", 0.3048},
                                                                           {"feet", 0.3048}}};
  for (const auto& [known, metres] : kUnits) {
    if (same_word(name, known)) return metres;
  }
  return std::nullopt;
}

Motion read_motion(const fs::path& file, const ReadOptions& options) {
  const std::string ending = file.extension().string();
  const std::string name = file.string();
  if (same_word(ending, ".bvh")) return parse_bvh(name, text_of(file));
  if (same_word(ending, ".trc")) return parse_trc(name, text_of(file));
  if (same_word(ending, ".c3d")) return parse_c3d(name, content(file));
  if (same_word(ending, ".csv")) return parse_robot_csv(name, text_of(file));
  if (same_word(ending, ".npz")) {
    return parse_amass(name, content(file), options.rest_pose.string(),
                       options.rest_pose.empty() ? std::string() : text_of(options.rest_pose));
  }
  if (same_word(ending, ".amc")) {
    const std::string amc = text_of(file);
    const fs::path skeleton = options.skeleton.empty() ? asf_beside(file) : options.skeleton;
    return parse_asf_amc(skeleton.string(), text_of(skeleton), name, amc);
  }
  files::raise({name}, "", fmt::format("has the ending '{}'", ending),
               "a file that ends in .bvh, .amc, .trc, .c3d, .npz or .csv");
}

}  // namespace pmg::mocap
