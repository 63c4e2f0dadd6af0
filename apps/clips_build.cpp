#include "clips_build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "files/config_error.hpp"
#include "generator/clip_report.hpp"
#include "generator/synthesis.hpp"
#include "json_output.hpp"
#include "model/clip_library_file.hpp"
#include "model/clip_library_writer.hpp"
#include "retargeting/build_library.hpp"
#include "shown_progress.hpp"

namespace pmg::apps {
namespace {
namespace fs = std::filesystem;
using retargeting::BuiltClip;
using retargeting::Likeness;
using retargeting::RetargetedClip;

/// Files of another library would be read with the new ones.
void expect_no_other_clips(const fs::path& out, const retargeting::LibraryRecipe& recipe) {
  std::set<std::string> made = {"bend", "lean", "squat", "inverse", "library"};
  for (const retargeting::ClipRecipe& clip : recipe.clips) {
    made.insert(clip.name);
    made.insert(model::half_gain_name(clip.name));
  }
  for (const fs::path& file : model::clip_library_files(out)) {
    if (made.contains(file.stem().string())) continue;
    files::raise({file.string()}, "", "is no part of this library, and would be read with it",
                 "a folder without clips of other libraries");
  }
}

double degrees(double rad) { return rad / kRadPerDegree; }

void print_likeness(const char* what, const RetargetedClip& made, Likeness retargeting::Imitation::*part) {
  const Likeness& of = made.likeness.*part;
  fmt::print("  {:5} r {:.3f}, RMS {:.1f} degrees from the human's", what, of.correlation, degrees(of.rms_rad));
  if (made.unmended) {
    const Likeness& before = made.unmended->likeness.*part;
    fmt::print(" ({:.3f}, {:.1f} before the fit for blending)", before.correlation, degrees(before.rms_rad));
  }
  fmt::print("\n");
}

void print_clip(const BuiltClip& clip, const model::RobotModel& robot) {
  const RetargetedClip& made = clip.made;
  const auto& human = made.human;
  const auto& v = made.clip.mean_velocity;
  fmt::print("{}: {}\n", clip.recipe.name, clip.source);
  for (const std::string& note : clip.notes) fmt::print("  note: {}\n", note);
  fmt::print("  human: T {:.3f} s, vx {:.3f}, vy {:.3f} m/s, omega {:.3f} rad/s, duty factors {:.2f} and {:.2f}\n",
             human.period_s, human.mean_velocity.x(), human.mean_velocity.y(), human.mean_velocity.z(),
             human.cut.contact[0].duty_factor, human.cut.contact[1].duty_factor);
  fmt::print("  cycle: ends {:.1f} cm apart, closing moved a direction by {:.3f}, events moved by {:.3f} of a cycle\n",
             100.0 * human.cut.loop_error_m, human.closing_moved_rad, human.warp_cycles);
  fmt::print("  robot: T {:.3f} s, vx {:.3f}, vy {:.3f} m/s, omega {:.3f} rad/s, duty factor {:.2f}\n",
             made.clip.period_s, v[0], v[1], v[2], made.clip.duty_factor[kLeft]);
  print_likeness("thigh", made, &retargeting::Imitation::thigh);
  print_likeness("knee", made, &retargeting::Imitation::knee);
  print_likeness("ankle", made, &retargeting::Imitation::ankle);
  fmt::print(
      "  feet: slide {:.1f} cm/s in double support (95th percentile {:.1f}), {:.1f} mm apart in height there,\n"
      "        a swinging one {:.1f} mm above the ground at least, {:.1f} mm in mid-swing, soles {:.0f} mm apart\n",
      100.0 * made.ground.slip_mean_m_s, 100.0 * made.ground.slip_p95_m_s, 1000.0 * made.ground.other_foot_height_m,
      1000.0 * made.ground.lowest_swing_m, 1000.0 * made.ground.clearance_m, 1000.0 * made.ground.foot_gap_m);
  fmt::print("  joints: seam jumps {:.4f} rad and {:.3f} rad/s, {:.3f} rad from limits, {:.0f} % of speed limits\n",
             made.seam.angle_rad, made.seam.speed_rad_s, made.limit_margin_rad, 100.0 * made.joint_speed_share);
  fmt::print("  retargeted in {:.2f} s: {:.0f} frames a second; fitted for blending in {:.1f} s\n", made.retarget_s,
             made.frames_per_s, made.fit_s);
  const auto c = static_cast<std::size_t>(clip.recipe.channel);
  const double end = clip.recipe.sign > 0.0 ? robot.command_limits.upper[c] : -robot.command_limits.lower[c];
  if (std::abs(v[c]) < end) {
    fmt::print("  note: the clip's {} is {:.3f}, robot.yaml's range ends at {:.3f}: commands beyond the clip are cut\n",
               kChannelNames[c], v[c], clip.recipe.sign * end);
  }
}

nlohmann::json clip_json(const BuiltClip& clip) {
  const RetargetedClip& made = clip.made;
  const auto likeness = [&made](Likeness retargeting::Imitation::*part) {
    const Likeness& of = made.likeness.*part;
    const Likeness before = made.unmended ? made.unmended->likeness.*part : of;
    return nlohmann::json{{"correlation", of.correlation},
                          {"rms_deg", degrees(of.rms_rad)},
                          {"unmended_correlation", before.correlation},
                          {"unmended_rms_deg", degrees(before.rms_rad)}};
  };
  return {{"source", clip.source},
          {"notes", clip.notes},
          {"human",
           {{"from_s", made.human.cut.from_s},
            {"to_s", made.human.cut.to_s},
            {"period_s", made.human.period_s},
            {"vx_m_s", made.human.mean_velocity.x()},
            {"vy_m_s", made.human.mean_velocity.y()},
            {"omega_rad_s", made.human.mean_velocity.z()},
            {"loop_error_m", made.human.cut.loop_error_m},
            {"warp_cycles", made.human.warp_cycles}}},
          {"period_s", made.clip.period_s},
          {"duty_factor", made.clip.duty_factor[kLeft]},
          {"vx_m_s", made.clip.mean_velocity[0]},
          {"vy_m_s", made.clip.mean_velocity[1]},
          {"omega_rad_s", made.clip.mean_velocity[2]},
          {"thigh", likeness(&retargeting::Imitation::thigh)},
          {"knee", likeness(&retargeting::Imitation::knee)},
          {"ankle", likeness(&retargeting::Imitation::ankle)},
          {"slip_mean_m_s", made.ground.slip_mean_m_s},
          {"slip_p95_m_s", made.ground.slip_p95_m_s},
          {"other_foot_height_m", made.ground.other_foot_height_m},
          {"lowest_swing_m", made.ground.lowest_swing_m},
          {"clearance_m", made.ground.clearance_m},
          {"foot_gap_m", made.ground.foot_gap_m},
          {"seam_rad", made.seam.angle_rad},
          {"seam_rad_s", made.seam.speed_rad_s},
          {"limit_margin_rad", made.limit_margin_rad},
          {"joint_speed_share", made.joint_speed_share},
          {"frames_per_s", made.frames_per_s},
          {"fit_s", made.fit_s}};
}

}  // namespace

CLI::App* add_build(CLI::App& app, BuildOptions& options) {
  CLI::App* command = app.add_subcommand("build", "Make a clip library from recordings of people");
  command->add_option("library", options.recipe, "LIBRARY.yaml: which recording becomes which clip")->required();
  command->add_option("--recordings", options.recordings, "folder of its recordings; the recipe's own if left out");
  command->add_option("--robot", options.robot, "robot's name, or its directory")->capture_default_str();
  command->add_option("--out", options.out, "directory for the clips")->required();
  command->add_flag("--no-inverse", options.no_inverse, "leave out inverse.csv, which takes minutes");
  command->add_flag("--json", options.json, "for machines");
  return command;
}

int build(const BuildOptions& options,
          const std::function<void(const model::RobotModel&, const fs::path&)>& add_inverse) {
  const retargeting::LibraryRecipe recipe = retargeting::read_library_recipe(options.recipe, options.recordings);
  const model::RobotModel robot = model::load_robot(model::find_robot(options.robot));
  model::require_writable(options.out);
  expect_no_other_clips(options.out, recipe);
  ProgressLine progress;
  const retargeting::BuiltLibrary built = retargeting::build_library(robot, recipe, shown(progress));
  progress.clear();
  const model::UnfinishedLibrary unfinished(options.out);
  model::write_clips(unfinished.folder(), built.library, robot, [&](const std::string& name) {
    const auto clip = std::ranges::find(built.clips, name, [](const BuiltClip& b) { return b.recipe.name; });
    return clip != built.clips.end() ? clip->source : generator::clip_source(name);
  });
  model::write_rules(unfinished.folder(), built.library);
  // What the generator would refuse is refused here; what `show` would fail is told below.
  const std::vector<generator::ClipReport> reports =
      generator::report(robot, model::load_clip_library(unfinished.folder(), robot));
  if (!options.no_inverse) add_inverse(robot, unfinished.folder());
  unfinished.finish();
  if (options.json) {
    nlohmann::json out;
    for (const BuiltClip& clip : built.clips) out["clips"][clip.recipe.name] = clip_json(clip);
    for (const generator::ClipReport& report : reports) out["clips"][report.name]["failure"] = report.failure;
    print_json(out);
    return 0;
  }
  for (const BuiltClip& clip : built.clips) print_clip(clip, robot);
  for (const generator::ClipReport& report : reports) {
    if (!report.failure.empty()) fmt::print("note: {} would fail `pmg_clips show`: {}\n", report.name, report.failure);
  }
  fmt::print("bend, lean, squat: {}\n", generator::clip_source("bend"));
  return 0;
}

}  // namespace pmg::apps
