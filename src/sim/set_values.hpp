// What a simulation has been told beside its robot's files: for people who read a log of it.
#pragma once

#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "sim/world.hpp"

namespace pmg::sim {

/// One line for each number of the world that the robot's files don't have ("left_knee: friction.coulomb_Nm = 1.2 Nm,
/// without it 0.2"): drives, variation, ground, sensor noise. Empty: the robot as its files say, on the usual ground,
/// without noise.
std::vector<std::string> set_values(const model::RobotModel& robot, const WorldOptions& options);

}  // namespace pmg::sim
