#include "retargeting/library_review.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "files/config_error.hpp"
#include "generator/gait_parts.hpp"
#include "mocap/gait_events.hpp"
#include "retargeting/build_library.hpp"
#include "retargeting/leg_imitation.hpp"
#include "retargeting/retargeting.hpp"
#include "work/parallel.hpp"

namespace pmg::retargeting {
namespace {
using mocap::KeyBody;
using mocap::Side;

const DynamicClip& clip_of(const ClipLibrary& library, const ClipRecipe& recipe) {
  const auto& clip = (recipe.sign > 0.0 ? library.positive : library.negative)[recipe.channel];
  if (!clip) files::raise(recipe.place, "clips." + recipe.name, "is not in the library", "the recipe of this library");
  if (clip->q.size() != generator::kClipSamples) {
    files::raise(recipe.place, "clips." + recipe.name, fmt::format("has {} samples in the library", clip->q.size()),
                 fmt::format("{}, as pmg_clips makes them", generator::kClipSamples));
  }
  return *clip;
}

mocap::SeamJump seam_of(const DynamicClip& clip) {
  std::vector<std::vector<double>> curves(static_cast<std::size_t>(clip.q.front().size()));
  for (const JointVector& q : clip.q) {
    for (std::size_t j = 0; j < curves.size(); ++j) curves[j].push_back(q[static_cast<Eigen::Index>(j)]);
  }
  return mocap::seam_jump(curves, clip.period_s);
}

/// Largest distance of a limb's end from where the human's directions put it with the robot's lengths. The limb has two
/// parts, from `root` over `middle` to `end`.
double limb_off_m(const std::vector<Figure>& robot, const HumanCycle& human, KeyBody root, KeyBody middle, KeyBody end,
                  Side side, Eigen::Vector3d SidePose::*upper, Eigen::Vector3d SidePose::*lower) {
  double largest_m = 0.0;
  for (std::size_t k = 0; k < robot.size(); ++k) {
    const auto at = [&](KeyBody left) { return *robot[k][static_cast<std::size_t>(of_side(left, side))]; };
    const SidePose& pose = human.pose[k].side[static_cast<std::size_t>(side)];
    const double upper_m = (at(middle) - at(root)).norm(), lower_m = (at(end) - at(middle)).norm();
    const Eigen::Vector3d wanted = upper_m * (pose.*upper) + lower_m * (pose.*lower);
    largest_m = std::max(largest_m, (at(end) - at(root) - wanted).norm());
  }
  return largest_m;
}

void measure_limbs(ReviewedClip& of) {
  const auto known = [&](KeyBody left) { return of.robot.front()[static_cast<std::size_t>(left)].has_value(); };
  const bool arms = of.human.pose.front().arms_known && known(KeyBody::left_wrist) && known(KeyBody::right_wrist);
  if (arms) of.hands_off_m = 0.0;
  for (const Side side : {Side::left, Side::right}) {
    of.feet_off_m = std::max(of.feet_off_m, limb_off_m(of.robot, of.human, KeyBody::left_hip, KeyBody::left_knee,
                                                       KeyBody::left_ankle, side, &SidePose::thigh, &SidePose::shank));
    if (!arms) continue;
    of.hands_off_m =
        std::max(*of.hands_off_m, limb_off_m(of.robot, of.human, KeyBody::left_shoulder, KeyBody::left_elbow,
                                             KeyBody::left_wrist, side, &SidePose::upper_arm, &SidePose::forearm));
  }
}

PlateReview review_plates(const ClipRecipe& recipe, const mocap::Recording& recording) {
  PlateReview out{mocap::read_force_plates(recipe.force_plates), {}};
  if (recipe.mirrored) std::swap(out.plates.contacts[0], out.plates.contacts[1]);
  const auto found = mocap::events_of(mocap::find_steps(recording));
  const auto add = [&out](const std::optional<double>& truth_s, const std::vector<double>& found_s) {
    if (!truth_s) return;
    const auto nearest = std::ranges::min_element(found_s, {}, [&](double t_s) { return std::abs(t_s - *truth_s); });
    out.errors_s.push_back(nearest == found_s.end() ? std::numeric_limits<double>::infinity() : *nearest - *truth_s);
  };
  for (std::size_t side = 0; side < 2; ++side) {
    for (const mocap::PlateContact& contact : out.plates.contacts[side]) {
      add(contact.contact_s, found[side].contact_s);
      add(contact.off_s, found[side].off_s);
    }
  }
  return out;
}

ReviewedClip review_clip(const generator::Making& making, const DynamicClip& clip, const ClipRecipe& recipe,
                         const mocap::NameTable& names, const work::Progress& progress) {
  const Source source = read_source(recipe, names);
  ReviewedClip out;
  out.recipe = recipe;
  out.notes = source.recording.notes;
  out.clip = clip;
  const RetargetedClip anew =
      retarget(making, source.recording, source.cut, recipe.channel, clip.duty_factor[kLeft], progress);
  out.human = anew.human;
  out.length_ratio = anew.length_ratio;
  out.froude_ratio = anew.froude_ratio;
  out.frames_per_s = anew.frames_per_s;
  out.person_legs = leg_angles(out.human);
  const generator::LegTrajectory legs = generator::leg_trajectory(clip, making.roles, 1.0, making.robot.q_stand());
  out.robot_legs = leg_angles(making.legs, legs.q, generator::base_of(making.robot, clip, 1.0));
  out.in_limits = imitation(leg_angles(making.legs, anew.gait.task.reference,
                                       std::vector<generator::BaseMotion>(anew.gait.task.reference.size())),
                            out.person_legs);
  out.on_ground = anew.likeness;
  out.made = imitation(out.robot_legs, out.person_legs);
  out.seam = seam_of(clip);
  out.robot = figures_of(making.robot, clip);
  out.person = figures_of(source.recording, out.human);
  for (Figure& figure : out.person) {
    for (std::optional<Eigen::Vector3d>& body : figure) {
      if (body) *body *= out.length_ratio;
    }
  }
  measure_limbs(out);
  if (!recipe.force_plates.empty()) out.plates = review_plates(recipe, source.recording);
  return out;
}

}  // namespace

LibraryReview review(const model::RobotModel& robot, const ClipLibrary& library, const LibraryRecipe& recipe,
                     const work::Progress& progress) {
  const generator::JointRoles roles = generator::find_joint_roles(robot);
  const generator::Making making{robot, roles, generator::robot_legs(robot, roles), {}};
  const mocap::NameTable names = names_of(recipe);
  const std::vector<generator::ClipReport> reports = generator::report(robot, library);
  LibraryReview out{.source = recipe.source, .robot = robot.name, .clips = {}};
  out.clips.resize(recipe.clips.size());
  for (const ClipRecipe& clip : recipe.clips) clip_of(library, clip);
  work::for_each_in_parallel(
      recipe.clips.size(), std::max(1U, std::thread::hardware_concurrency()),
      [&](std::size_t i) {
        out.clips[i] = review_clip(making, clip_of(library, recipe.clips[i]), recipe.clips[i], names,
                                   {.interrupted = progress.interrupted});
      },
      progress);
  if (progress.interrupted_now()) throw work::Interrupted();
  for (ReviewedClip& clip : out.clips) {
    clip.ground = *std::ranges::find(reports, clip.recipe.name, &generator::ClipReport::name);
    out.dynamic_total_s += clip.clip.period_s;
  }
  return out;
}

}  // namespace pmg::retargeting
