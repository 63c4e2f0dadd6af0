// The joints of a robot by their role in the human body, found by name: "left_knee", "right_hip_roll", "waist_yaw".
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

/// Indices in the robot's joint order. Legs are required; other parts move only if the robot has them.
struct JointRoles {
  PerFoot<std::array<int, kLegJoints>> leg{};  ///< by LegRole
  std::optional<int> waist_yaw, waist_roll, waist_pitch, head_yaw, head_pitch;
  PerFoot<std::optional<int>> shoulder_pitch, shoulder_roll, elbow;
};

/// Throws files::ConfigError if a leg lacks one of the six roles or has another moving joint.
JointRoles find_joint_roles(const model::RobotModel& robot);

}  // namespace pmg::generator
