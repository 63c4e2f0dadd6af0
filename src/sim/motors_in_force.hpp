// Which motor.yaml a simulation of a robot has.
#pragma once

#include <filesystem>

#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"

namespace pmg::sim {

/// The file that is named ("none": none), or else the one that robot.yaml's `motor` names, beside it; or none. Throws
/// as read_motor_file.
ActuatorsByJoint motors_in_force(const model::RobotModel& robot, const std::filesystem::path& named);

}  // namespace pmg::sim
