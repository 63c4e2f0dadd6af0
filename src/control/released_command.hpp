// The joint command of a robot that nothing drives.
#pragma once

#include "model/robot_io.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

/// Each joint's measured position with kp = 0, no feedforward torque and the damping brake_kd_Nm_s_per_rad; nullptr: no
/// damping either. The command has as many joints as its dq; a measurement that does not fit them, or is not
/// finite, becomes zero.
void release_command(const model::RobotState& state, const JointVector* brake_kd_Nm_s_per_rad,
                     model::JointCommand& command) noexcept;

}  // namespace pmg::control
