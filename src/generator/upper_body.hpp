// What trunk, arms and head do while the legs walk.
#pragma once

#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

/// Amounts at full gain.
struct UpperBody {
  double pelvis_tilt_rad = 0.0;  ///< the pelvis pitches forward, the waist takes it back: the torso stays upright
  double arm_swing = 0.0;        ///< of the published one; negative: in phase with the same side's leg
  double torso_yaw_rad = 0.0;    ///< amplitude, against the legs
  double gaze_yaw_rad = 0.0;     ///< the head looks this far to the left of the torso
};

/// Sets every joint but the legs' to the standing posture plus its part of the movement, and lets the hips make up for
/// the pelvis' tilt. q comes with the legs as they are under a level pelvis.
void move_upper_body(const JointRoles& roles, const UpperBody& body, double phase, JointVector& q);

}  // namespace pmg::generator
