// From one gait cycle of a human to a dynamic clip of a robot (paper III-A.1).
#pragma once

#include <optional>
#include <vector>

#include "generator/gait_measure.hpp"
#include "generator/gait_parts.hpp"
#include "pmg/clip.hpp"
#include "retargeting/human_cycle.hpp"
#include "retargeting/likeness.hpp"
#include "work/progress.hpp"

namespace pmg::retargeting {

/// A clip before fit_full_gain.
struct Unmended {
  Imitation likeness;
  generator::GroundMeasure ground;
};

struct RetargetedClip {
  DynamicClip clip;
  generator::MadeGait gait;                 ///< what the optimisation was asked and gave
  std::optional<generator::MadeGait> half;  ///< the same at half gain, after fit_half_gain
  HumanCycle human;
  double length_ratio = 1.0;  ///< robot's leg over the human's
  double froude_ratio = 1.0;  ///< sqrt(length_ratio): robot's period over the human's, and its speed over the human's
  Eigen::Vector3d wanted_velocity = Eigen::Vector3d::Zero();  ///< of the clip's channel alone: vx, vy [m/s], omega
  Imitation likeness;                                         ///< of the clip
  std::optional<Unmended> unmended;
  generator::GroundMeasure ground;       ///< at full gain
  mocap::SeamJump seam;                  ///< of the clip's joints
  double limit_margin_rad = 0.0;         ///< smallest distance from a joint limit; negative: beyond it
  double joint_speed_share = 0.0;        ///< of the joints' limits, largest
  double retarget_s = 0.0, fit_s = 0.0;  ///< CPU time of retarget, and of both fits
  double frames_per_s = 0.0;             ///< clip samples that retarget made a second
};

/// (robot, recording, cycle, channel) => (clip). Lengths scale by l = robot's leg / human's, times and speeds by
/// sqrt(l), so that Froude's number v^2 / (g leg) stays (R. Alexander, Physiol. Rev. 69(4), 1989). Of the human's mean
/// velocity the channel's component is kept: a primitive moves in one direction. First each pose is imitated limb by
/// limb (leg_imitation.hpp); then generator::optimize_gait makes the feet agree with the ground near
/// these curves, at full gain alone. duty_factor: of the clip; nullopt: the human's. Deterministic. Throws
/// files::ConfigError, and work::Interrupted where progress is over.
RetargetedClip retarget(const generator::Making& making, const mocap::Recording& recording, const mocap::GaitCycle& cut,
                        Channel channel, std::optional<double> duty_factor = {}, const work::Progress& progress = {});

/// Makes the clip anew at full gain alone, as a library is accepted with it, with the person's arms.
/// The curves leave the human's as far as that needs; likeness says how far, unmended what it was before. Throws
/// work::Interrupted where progress is over.
void fit_full_gain(const generator::Making& making, RetargetedClip& made, const work::Progress& progress = {});

/// Leaves the clip as it is and makes its half-gain clip, so that the feet keep to the ground at every gain, in
/// postures, and in mixtures with these other clips, whose half-gain clips count where they have them: joint angles
/// blend linearly, heights of feet don't. Throws work::Interrupted where progress is over.
void fit_half_gain(const generator::Making& making, const std::vector<const RetargetedClip*>& others,
                   RetargetedClip& made, const work::Progress& progress = {});

}  // namespace pmg::retargeting
