// The posture clips: feet flat and in place, the centre of mass above them.
#pragma once

#include "generator/gait_optimization.hpp"
#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

/// The pelvis' share of a bend; the waist takes the rest. People's share is similar.
inline constexpr double kPelvisShareOfPitch = 0.4;

/// Torso pitch (+ forward) over the robot's command range, by the pelvis about the hips and by the waist.
StaticClip make_bend(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs);
/// Torso roll (+ right); the base stays level and moves a little to the other side.
StaticClip make_lean(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs);
/// Base height with an upright torso. The clip ends where the legs are nearly straight, if the range goes beyond.
StaticClip make_squat(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs);

/// The legs' part of a posture: deviation from stand at this command, linear between rows as in the generator.
LegPose leg_offset(const StaticClip& clip, const JointRoles& roles, const RobotLegs& legs, double command);

}  // namespace pmg::generator
