// A robot's leg in the directions of a human's: limb by limb, whatever the lengths.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "generator/gait_optimization.hpp"
#include "retargeting/human_pose.hpp"

namespace pmg::retargeting {

/// Directions of the robot's leg at these angles, in the base frame. Arms stay as SidePose has them.
SidePose leg_directions(const generator::LegGeometry& leg, const generator::LegVector<double>& q);

/// Where the leg is, in the base frame [m]; the sole's corners as LegGeometry has them.
struct LegPoints {
  Eigen::Vector3d hip, knee, ankle;
  std::array<Eigen::Vector3d, 4> sole;
};
LegPoints leg_points(const generator::LegGeometry& leg, const generator::LegVector<double>& q);

/// Length from the hips' last joint over the knee to the ankle [m].
double leg_length_m(const generator::LegGeometry& leg);

/// (legs, poses) => (joint angles), one a pose, within the limits less margin_rad. For each pose and leg
///   min |t - t_h|^2 + |s - s_h|^2 + |f - f_h|^2 + n_z^2 + 1e-4 |q - q_before|^2
/// over the six angles: thigh t, shank s, sole f, the sole's lateral axis n; q_before is the pose before's solution.
std::vector<generator::LegPose> imitate_legs(const generator::RobotLegs& legs, const std::vector<HumanPose>& poses,
                                             double margin_rad);

}  // namespace pmg::retargeting
