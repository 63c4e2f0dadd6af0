// The actuators of a simulated robot: robot.yaml's numbers, replaced where a motor.yaml gives others.
#pragma once

#include <filesystem>

#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"

namespace pmg::sim {

/// The actuators of the file `named` ("none": no file), else of the file that robot.yaml's `motor` names, else none.
/// Throws as read_motor_file.
ActuatorsByJoint motors_in_force(const model::RobotModel& robot, const std::filesystem::path& named);

/// The joint's actuator, always with an effort limit, a rotor and friction. What `motors` leaves neutral comes from
/// robot.yaml: an infinite drive.limit becomes the effort limit, an armature of zero the joint's armature_kg_m2, and
/// friction that is all neutral the joint's friction_Nm (Coulomb) and damping_Nm_s_per_rad (viscous). Gains come with
/// each command.
model::ActuatorParameters actuator_in_force(const model::Joint& joint, const ActuatorsByJoint& motors);

}  // namespace pmg::sim
