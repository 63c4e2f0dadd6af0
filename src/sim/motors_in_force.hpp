// Which actuators a simulation of a robot has: robot.yaml's numbers, and a motor.yaml's where it says more.
#pragma once

#include <filesystem>

#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"

namespace pmg::sim {

/// The file that is named ("none": none), or else the one that robot.yaml's `motor` names, beside it; or none. Throws
/// as read_motor_file.
ActuatorsByJoint motors_in_force(const model::RobotModel& robot, const std::filesystem::path& named);

/// The joint's actuator, with an effort limit, a rotor and friction in any case. What `motors` doesn't say is
/// robot.yaml's: an infinite drive.limit becomes the effort limit, an armature of zero the joint's armature_kg_m2, and
/// friction that is all neutral the joint's friction_Nm (Coulomb) and damping_Nm_s_per_rad (viscous). Gains come with
/// each command.
ActuatorParameters actuator_in_force(const model::Joint& joint, const ActuatorsByJoint& motors);

}  // namespace pmg::sim
