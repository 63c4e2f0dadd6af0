// An actuator model drives a joint of a MuJoCo model; whole robots and single joints use the same two functions.
#pragma once

#include <mujoco/mujoco.h>

#include "sim/actuator_model.hpp"

namespace pmg::sim {

/// Gives the joint the actuator model's armature, and switches off MuJoCo's own damping, friction and torque limit.
/// Call mj_setConst afterwards.
void hand_over(mjModel* model, int actuator, const ActuatorModel& by);

/// Sets the torque of the next step: ctrl = torque - slope dq, and MuJoCo's force is ctrl + slope dq' with the speed
/// dq' at the step's end, because the integrator (`implicit`) takes the slope implicitly. dq_rad_s: the joint's speed
/// in data.
void apply(mjModel* model, mjData* data, int actuator, const ActuatorTorque& torque, double dq_rad_s) noexcept;

}  // namespace pmg::sim
