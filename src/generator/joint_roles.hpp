// Which joint of a robot plays which part of the human body, found by name: "left_knee", "right_hip_roll", "waist_yaw",
// ...
#pragma once

#include <array>
#include <optional>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

enum LegRole : std::size_t { kHipPitch = 0, kHipRoll, kHipYaw, kKnee, kAnklePitch, kAnkleRoll };
inline constexpr int kLegJoints = 6;
inline constexpr std::array<const char*, kLegJoints> kLegRoleNames = {"hip_pitch", "hip_roll",    "hip_yaw",
                                                                      "knee",      "ankle_pitch", "ankle_roll"};

/// Indices in the robot's joint order. Legs are required, the rest moves only where the robot has it.
struct JointRoles {
  PerFoot<std::array<int, kLegJoints>> leg{};  ///< by LegRole
  std::optional<int> waist_yaw, waist_roll, waist_pitch, head_yaw, head_pitch;
  PerFoot<std::optional<int>> shoulder_pitch, shoulder_roll, elbow;
};

/// Throws model::ConfigError when a leg lacks one of the six roles or has another moving joint.
JointRoles find_joint_roles(const model::RobotModel& robot);

}  // namespace pmg::generator
