// What a person does in a recording: walks, turns, squats, bends, leans and stands, with times and figures.
#pragma once

#include <string>
#include <vector>

#include "mocap/gait_events.hpp"

namespace pmg::mocap {

/// Thresholds between activities. Lengths and speeds are shares of the body's own, so children and robots count too.
struct ActivityOptions {
  /// Slower than this share of sqrt(g leg length) is stepping in place (0.27 m/s for an adult; people walk at 0.4).
  double walking_speed = 0.09;
  /// A turn of more than this in one gait cycle is turning: half of the 30 degrees that a foot placement can hide.
  double turning_rad_per_cycle = 0.26;
  /// Free gait cycle in units of sqrt(leg length / g): 1.1 s for an adult of 0.85 m.
  double free_cycle = 3.75;
  /// Two steps with a longer pause between them, in free cycles, are two walks.
  double longest_pause_cycles = 0.6;
  /// A squat lowers the pelvis by this share of the leg's length at least, and lasts while it is this much lower.
  double squat_depth = 0.25, squat_edge = 0.08;
  /// A bend pitches the trunk by this, a lean rolls it, beyond its median [rad]. Walking trunks sway by 0.1.
  double bend_rad = 0.5, lean_rad = 0.21;
  /// An episode of posture lasts while the angle is above this share of its threshold.
  double posture_edge = 0.4;
  double shortest_stand_s = 0.5;  ///< without steps and posture
};

enum class ActivityKind {
  kWalkForward,
  kWalkBackward,
  kSideLeft,
  kSideRight,
  kCircleLeft,
  kCircleRight,
  kTurnLeft,
  kTurnRight,
  kStepInPlace,
  kSquat,
  kBend,
  kLeanLeft,
  kLeanRight,
  kStand
};
const char* name_of(ActivityKind kind);

struct Activity {
  ActivityKind kind = ActivityKind::kStand;
  double from_s = 0.0, to_s = 0.0;
  double vx_m_s = 0.0, vy_m_s = 0.0;  ///< mean of the pelvis in its heading frame, x forward, y left
  double yaw_rad = 0.0;               ///< turned in all, + left
  int steps = 0;
  double steps_per_min = 0.0;              ///< cadence, without the pauses before and after
  double pelvis_drop_m = 0.0;              ///< largest, below standing
  double pitch_rad = 0.0, roll_rad = 0.0;  ///< extremes of the trunk, + forward and + right
  double duration_s() const { return to_s - from_s; }
  double yaw_rate_rad_s() const { return yaw_rad / duration_s(); }
};

/// Pelvis and trunk of each frame.
struct BodyCourse {
  Positions pelvis_m;               ///< z above the ground
  std::vector<double> heading_rad;  ///< of the hips (or shoulders, or the pelvis' own frame), unwrapped
  std::vector<double> pitch_rad,
      roll_rad;  ///< of pelvis to neck against the vertical, in the heading frame; empty without a neck
  double standing_height_m = 0.0;  ///< of the pelvis: 90th percentile
};

/// Empty vectors if the recording lacks the pelvis.
BodyCourse course_of(const Recording& recording);

/// In the order of their begin. Stretches of walking and of posture may overlap: people bend while they turn.
std::vector<Activity> find_activities(const Recording& recording, const BodyCourse& course,
                                      const std::vector<Step>& steps, const ActivityOptions& options = {});

}  // namespace pmg::mocap
