// Directions of a human's limbs: what a robot of other proportions imitates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mocap/gait_cycle.hpp"
#include "mocap_files/recording.hpp"

namespace pmg::retargeting {

/// Unit vectors of one side, in the heading frame of the pelvis (x forward, y left, z up).
struct SidePose {
  Eigen::Vector3d thigh = -Eigen::Vector3d::UnitZ(), shank = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d sole = Eigen::Vector3d::UnitX();  ///< from heel to toe
  Eigen::Vector3d upper_arm = -Eigen::Vector3d::UnitZ(), forearm = -Eigen::Vector3d::UnitZ();
};

/// A human at one instant.
struct HumanPose {
  std::array<SidePose, 2> side;   ///< by mocap::Side
  double pelvis_roll_rad = 0.0;   ///< of the line through the hips, + the right hip lower
  double shoulder_yaw_rad = 0.0;  ///< of the line through the shoulders, + left
  double pelvis_left_m = 0.0;     ///< sideways from its mean line
  bool arms_known = false;
};

/// Directions as curves over the recording, as mocap::close_cycle takes them. The heading frame turns steadily from the
/// heading at from_s to that at to_s, shifted by the mean difference: pelvis yaw within the cycle stays in the curves.
/// Throws files::ConfigError if the recording lacks a body of the legs.
struct PoseCurves {
  mocap::HumanAngles curves;
  Eigen::Vector3d mean_velocity = Eigen::Vector3d::Zero();  ///< vx, vy [m/s], omega [rad/s] of the pelvis in its frame
  bool arms_known = false;
};
PoseCurves pose_curves(const mocap::Recording& recording, double from_s, double to_s);

/// The pose at one sample of closed curves; directions are normalised.
HumanPose pose_of(const std::vector<double>& values, bool arms_known);

/// Left and right exchanged by reflection in the plane y = 0. Twice gives the recording itself.
mocap::Recording mirrored(const mocap::Recording& recording);

// Angles in the sagittal plane, of people and robots alike.
double thigh_pitch_rad(const SidePose& pose);    ///< + knee to the front
double knee_flexion_rad(const SidePose& pose);   ///< between thigh and shank
double ankle_flexion_rad(const SidePose& pose);  ///< + toes up, 0 where the sole is perpendicular to the shank

}  // namespace pmg::retargeting
