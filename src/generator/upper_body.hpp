// Motion of trunk, arms and head while the legs walk.
#pragma once

#include <functional>

#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

/// Amounts at full gain.
struct UpperBody {
  double pelvis_tilt_rad = 0.0;  ///< forward pitch of the pelvis; the waist undoes it, so the torso stays upright
  std::function<double(double phase)> pelvis_roll_rad = {};  ///< the waist undoes it too; empty: none
  double arm_swing = 0.0;      ///< factor on the published swing; negative: in phase with the leg of the same side
  double torso_yaw_rad = 0.0;  ///< amplitude, against the legs
  double gaze_yaw_rad = 0.0;   ///< the head looks this far to the left of the torso
};

/// Sets every joint except the legs' to the standing posture plus its part of the movement; the hips undo the pelvis'
/// tilt. The pelvis' attitude in the heading frame is R_HB = Rx(roll) Ry(tilt), so hip pitch, the legs' first joint,
/// can undo the tilt. q contains the legs for a pelvis without tilt.
void move_upper_body(const JointRoles& roles, const UpperBody& body, double phase, JointVector& q);

}  // namespace pmg::generator
