// The joints between two links of a robot.
#pragma once

#include <string>

#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"

namespace pmg::model {

/// Throws std::invalid_argument if no chain of the robot's joints leads from one link to the other.
ChainKinematics chain_between(const RobotModel& robot, const std::string& from, const std::string& to);

}  // namespace pmg::model
