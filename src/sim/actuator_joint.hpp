// How an actuator model moves a joint of a MuJoCo model: the one way, for whole robots and for single joints.
#pragma once

#include <mujoco/mujoco.h>

#include "sim/actuator_model.hpp"

namespace pmg::sim {

/// The joint's armature, damping, friction and torque limit become the actuator model's. Call mj_setConst afterwards.
void hand_over(mjModel* model, int actuator, const ActuatorModel& by);

/// Sets the torque of the step to come; the integrator (`implicit`) takes the slope implicitly. dq: of data's state.
void apply(mjModel* model, mjData* data, int actuator, const ActuatorTorque& torque, double dq_rad_s) noexcept;

}  // namespace pmg::sim
