// What trunk, arms and head do while the legs walk.
#pragma once

#include <functional>

#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

/// Amounts at full gain.
struct UpperBody {
  double pelvis_tilt_rad = 0.0;  ///< the pelvis pitches forward, the waist takes it back: the torso stays upright
  std::function<double(double phase)> pelvis_roll_rad = {};  ///< the waist takes it back too; none if empty
  double arm_swing = 0.0;      ///< of the published one; negative: in phase with the same side's leg
  double torso_yaw_rad = 0.0;  ///< amplitude, against the legs
  double gaze_yaw_rad = 0.0;   ///< the head looks this far to the left of the torso
};

/// Pelvis in the heading frame: R_HB = Rx(roll) Ry(tilt), so that hip pitch, the legs' first joint, undoes the tilt.
/// Sets every joint but the legs' to the standing posture plus its part of the movement, and lets the hips make up for
/// the pelvis' tilt. q comes with the legs as they are under a pelvis without tilt.
void move_upper_body(const JointRoles& roles, const UpperBody& body, double phase, JointVector& q);

}  // namespace pmg::generator
