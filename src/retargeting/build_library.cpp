#include "retargeting/build_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

#include "files/config_error.hpp"
#include "fitting/statistics.hpp"
#include "generator/static_clips.hpp"
#include "mocap/activities.hpp"
#include "mocap/gait_events.hpp"
#include "mocap_files/key_bodies.hpp"
#include "work/parallel.hpp"

namespace pmg::retargeting {
namespace {
using mocap::ActivityKind;

/// The activities that show a primitive, the best first.
std::vector<ActivityKind> kinds_of(const ClipRecipe& recipe) {
  const bool positive = recipe.sign > 0.0;
  if (recipe.channel == kVx) return {positive ? ActivityKind::kWalkForward : ActivityKind::kWalkBackward};
  if (recipe.channel == kVy) return {positive ? ActivityKind::kSideLeft : ActivityKind::kSideRight};
  return positive ? std::vector{ActivityKind::kTurnLeft, ActivityKind::kCircleLeft}
                  : std::vector{ActivityKind::kTurnRight, ActivityKind::kCircleRight};
}

std::optional<mocap::GaitCycle> automatic_cycle(const ClipRecipe& recipe, const mocap::Recording& recording,
                                                const std::vector<mocap::Step>& steps) {
  const auto activities = mocap::find_activities(recording, mocap::course_of(recording), steps);
  for (const ActivityKind kind : kinds_of(recipe)) {
    std::optional<mocap::GaitCycle> best;
    for (const mocap::Activity& activity : activities) {
      if (activity.kind != kind) continue;
      const auto cycle = mocap::best_cycle(recording, steps, activity.from_s, activity.to_s);
      if (cycle && (!best || cycle->loop_error_m < best->loop_error_m)) best = cycle;
    }
    if (best) return best;
  }
  return std::nullopt;
}

/// Walking in the clip's direction, with the largest part of the velocity there.
void expect_direction(const ClipRecipe& recipe, const RetargetedClip& made) {
  const double speed = made.human.mean_velocity[static_cast<Eigen::Index>(recipe.channel)];
  if (speed * recipe.sign > 0.0) return;
  files::raise(recipe.frames_place, "clips." + recipe.name + ".frames",
               fmt::format("choose a cycle from {:.2f} to {:.2f} s whose {} is {:.2f}", made.human.cut.from_s,
                           made.human.cut.to_s, kChannelNames[recipe.channel], speed),
               recipe.sign > 0.0 ? "a number above 0" : "a number below 0");
}

void expect_limits(const ClipRecipe& recipe, const RetargetedClip& made) {
  if (made.limit_margin_rad >= 0.0) return;
  files::raise(recipe.place, "clips." + recipe.name,
               fmt::format("takes a joint {:.3f} rad beyond its limit", -made.limit_margin_rad),
               "a motion that the robot's joints can imitate");
}

std::string source_of(const LibraryRecipe& recipe, const ClipRecipe& clip, const RetargetedClip& made) {
  return fmt::format(
      "retargeted from {}{}, {:.3f} to {:.3f} s ({}); scaled by Froude's law: legs {:.3f} m for {:.3f} m, lengths "
      "times "
      "{:.3f}, period and speed times {:.3f}",
      clip.recording.filename().string(), clip.mirrored ? ", mirrored" : "", made.human.cut.from_s, made.human.cut.to_s,
      recipe.source, made.length_ratio * made.human.leg_length_m, made.human.leg_length_m, made.length_ratio,
      made.froude_ratio);
}

/// The library's where its recipe states none: one cycle of another kind, a turn in steps with pauses, is warped to it
/// and not all others to that.
double median_duty_factor(const std::vector<Source>& sources) {
  std::vector<double> r;
  for (const Source& source : sources) r.push_back(duty_factor_of(source.cut));
  return fitting::median(std::move(r));
}

/// A part of the work: these clips can be made side by side.
struct Pass {
  std::vector<std::size_t> clips;
  bool retargets = false;  ///< from the recording, before the fit
  std::function<void(std::size_t, const work::Progress&)> fit;
};

std::vector<std::size_t> of_channel(const std::vector<BuiltClip>& clips, std::size_t channel) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    if (clips[i].recipe.channel == channel) list.push_back(i);
  }
  return list;
}

/// Clips at full gain know nothing of each other. Half-gain clips are made channel after channel, in two sweeps: in the
/// second one each mixes with all others as they are.
std::vector<Pass> all_passes(const generator::Making& making, std::vector<BuiltClip>& clips) {
  std::vector<std::size_t> all(clips.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<Pass> passes = {{all, true, [&making, &clips](std::size_t i, const work::Progress& progress) {
                                 fit_full_gain(making, clips[i].made, progress);
                               }}};
  constexpr int kSweeps = 2;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      passes.push_back({of_channel(clips, channel), false,
                        [&making, &clips, channel](std::size_t i, const work::Progress& progress) {
                          std::vector<const RetargetedClip*> others;
                          for (const BuiltClip& other : clips) {
                            if (other.recipe.channel != channel && other.made.half) others.push_back(&other.made);
                          }
                          fit_half_gain(making, others, clips[i].made, progress);
                        }});
    }
  }
  return passes;
}

}  // namespace

mocap::GaitCycle chosen_cycle(const ClipRecipe& recipe, const mocap::Recording& recording) {
  const std::vector<mocap::Step> steps = mocap::find_steps(recording);
  const auto cycle = recipe.frames ? mocap::best_cycle(recording, steps, recipe.frames->first / recording.rate_hz,
                                                       recipe.frames->second / recording.rate_hz)
                                   : automatic_cycle(recipe, recording, steps);
  if (!cycle) {
    files::raise(recipe.frames_place, "clips." + recipe.name + ".frames",
                 recipe.frames ? fmt::format("[{}, {}) of {} have no gait cycle", recipe.frames->first,
                                             recipe.frames->second, recipe.recording.filename().string())
                               : fmt::format("no stretch of {} shows {} with a whole cycle",
                                             recipe.recording.filename().string(), recipe.name),
                 "three steps or more; pmg_clips inspect tells what a recording holds");
  }
  return *cycle;
}

Source read_source(const ClipRecipe& recipe, const mocap::NameTable& names) {
  mocap::Recording recording = mocap::make_recording(
      recipe.recording.string(), mocap::read_motion(recipe.recording, recipe.read), names, recipe.options);
  if (recipe.mirrored) recording = mirrored(recording);
  const mocap::GaitCycle cut = chosen_cycle(recipe, recording);
  return {std::move(recording), cut};
}

mocap::NameTable names_of(const LibraryRecipe& recipe) {
  return mocap::read_name_table(recipe.names ? *recipe.names : mocap::default_name_table());
}

BuiltLibrary build_library(const model::RobotModel& robot, const LibraryRecipe& recipe,
                           const work::Progress& progress) {
  const generator::JointRoles roles = generator::find_joint_roles(robot);
  generator::Making making{robot, roles, generator::robot_legs(robot, roles), {}};
  BuiltLibrary built;
  ClipLibrary& library = built.library;
  library.q_stand = robot.q_stand();
  library.q_lower = robot.q_lower();
  library.q_upper = robot.q_upper();
  library.mirror = robot.mirror;
  making.posture = {generator::make_bend(robot, roles, making.legs), generator::make_lean(robot, roles, making.legs),
                    generator::make_squat(robot, roles, making.legs)};
  library.posture = making.posture;

  const mocap::NameTable names = names_of(recipe);
  std::vector<Source> sources;
  for (const ClipRecipe& clip : recipe.clips) {
    progress.report_or_throw(0.0, "reading " + clip.recording.filename().string());
    sources.push_back(read_source(clip, names));
  }

  const double duty_factor = recipe.duty_factor.value_or(median_duty_factor(sources));

  built.clips.resize(recipe.clips.size());
  for (std::size_t i = 0; i < recipe.clips.size(); ++i) built.clips[i].recipe = recipe.clips[i];
  const std::vector<Pass> passes = all_passes(making, built.clips);
  std::size_t all = 0, done = 0;
  for (const Pass& pass : passes) all += pass.clips.size();
  for (const Pass& pass : passes) {
    work::for_each_in_parallel(
        pass.clips.size(), std::max(1U, std::thread::hardware_concurrency()),
        [&](std::size_t k) {
          const std::size_t i = pass.clips[k];
          const work::Progress within{.interrupted = progress.interrupted};
          if (pass.retargets) {
            built.clips[i].made =
                retarget(making, sources[i].recording, sources[i].cut, recipe.clips[i].channel, duty_factor, within);
            expect_direction(recipe.clips[i], built.clips[i].made);
          }
          pass.fit(i, within);
        },
        {.report =
             [&](double share, std::string_view) {
               if (progress.report)
                 progress.report((static_cast<double>(done) + share * static_cast<double>(pass.clips.size())) /
                                     static_cast<double>(all),
                                 "retargeting");
             },
         .interrupted = progress.interrupted});
    if (progress.interrupted_now()) throw work::Interrupted();
    done += pass.clips.size();
  }
  for (std::size_t i = 0; i < recipe.clips.size(); ++i) {
    expect_limits(recipe.clips[i], built.clips[i].made);
    built.clips[i].source = source_of(recipe, recipe.clips[i], built.clips[i].made);
    built.clips[i].notes = sources[i].recording.notes;
  }
  VelocityScale scale;
  for (const BuiltClip& clip : built.clips) {
    const double speed = std::abs(clip.made.clip.mean_velocity[clip.recipe.channel]);
    (clip.recipe.sign > 0.0 ? library.positive : library.negative)[clip.recipe.channel] = clip.made.clip;
    (clip.recipe.sign > 0.0 ? scale.positive : scale.negative)[clip.recipe.channel] = speed;
  }
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {  // the generator mirrors it
    if (!library.negative[channel]) scale.negative[channel] = scale.positive[channel];
  }
  library.velocity_scale = scale;
  return built;
}

}  // namespace pmg::retargeting
