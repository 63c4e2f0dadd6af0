// A robot's arms in the directions of a human's, clear of its legs.
#pragma once

#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "retargeting/human_cycle.hpp"

namespace pmg::retargeting {

/// Forearm and hand keep this from legs and pelvis [m]: drives that lag and mixtures with other clips take some of it.
inline constexpr double kArmClearance_m = 0.015;

/// Sets the joints from shoulder to elbow of each sample of the clip, whose legs and trunk are made. For each sample
/// and arm
///   min |a - a_h|^2 + |f - f_h|^2 + 0.01 |q - q_before|^2 + (30 / m sum max(0, c - d))^2
/// within the joints' limits less margin_rad: upper arm a and forearm f under an upright torso, and the distances d of
/// forearm and hand from legs and pelvis, c = kArmClearance_m. Arms that person or robot lacks stay as they are. Slopes
/// of the clip are made anew.
void imitate_arms(const model::RobotModel& robot, const generator::JointRoles& roles, const HumanCycle& human,
                  double margin_rad, DynamicClip& clip);

/// Smallest distance of a forearm or hand from a leg or the pelvis over the cycle [m]; a robot without arms: infinity.
double arm_clearance_m(const model::RobotModel& robot, const generator::JointRoles& roles, const DynamicClip& clip);

}  // namespace pmg::retargeting
