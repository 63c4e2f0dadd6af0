// A library on disk beside the people of its recipe: everything that a page of it judges.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/clip_report.hpp"
#include "mocap/gait_cycle.hpp"
#include "mocap_files/force_plates.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "retargeting/figure.hpp"
#include "retargeting/library_recipe.hpp"
#include "retargeting/likeness.hpp"
#include "work/progress.hpp"

namespace pmg::retargeting {

/// What a clip is asked for.
struct ClipGoals {
  double seam_rad = 0.02, seam_rad_s = 0.3;
  double slide_m_s = 0.02;       ///< of stance feet, mean
  double penetration_m = 0.010;  ///< of a sole
  double correlation = 0.98;     ///< of thigh, knee and ankle with the same human's
  double rms_rad = 5.0 * kRadPerDegree;
  double scaled_off_m = 0.03;                            ///< hands and feet from the human's, limbs scaled
  double dynamic_total_s = 10.0;                         ///< all dynamic clips
  double event_mean_s = 0.015, event_largest_s = 0.030;  ///< gait events from those on force plates
};

/// Gait events by the motion against force plates.
struct PlateReview {
  mocap::ForcePlates plates;     ///< sides exchanged as the recording's
  std::vector<double> errors_s;  ///< for each event on a plate: the nearest one found minus it
};

struct ReviewedClip {
  ClipRecipe recipe;
  std::vector<std::string> notes;  ///< what the reader of the recording guessed
  HumanCycle human;                ///< warped to the clip's duty factor
  DynamicClip clip;
  double length_ratio = 1.0, froude_ratio = 1.0;  ///< as of RetargetedClip
  std::vector<Figure> person, robot;              ///< the person's lengths times length_ratio
  PerFoot<LegAngles> person_legs, robot_legs;
  /// In three steps, each with the one before: inside the joints' limits alone; with feet on the ground at full gain;
  /// the clip on disk, which mixes.
  Imitation in_limits, on_ground, made;
  generator::ClipReport ground;
  mocap::SeamJump seam;
  double feet_off_m = 0.0;            ///< ankles seen from the hips, largest over cycle and sides
  std::optional<double> hands_off_m;  ///< wrists seen from the shoulders; nullopt: person or robot lacks an arm
  std::optional<PlateReview> plates;
  double frames_per_s = 0.0;  ///< of retargeting up to full gain, CPU time
};

struct LibraryReview {
  std::string source, robot;
  std::vector<ReviewedClip> clips;
  double dynamic_total_s = 0.0;
};

/// (robot, its library, the recipe that it was made from) => (review). Throws files::ConfigError if the recipe's clips
/// aren't in the library or a recording can't be read, and work::Interrupted.
LibraryReview review(const model::RobotModel& robot, const ClipLibrary& library, const LibraryRecipe& recipe,
                     const work::Progress& progress = {});

}  // namespace pmg::retargeting
