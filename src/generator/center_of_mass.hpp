// Where the robot's mass is, for postures that must not topple.
#pragma once

#include <Eigen/Core>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

/// Centre of mass [m] in the base frame; q: all joints [rad].
Eigen::Vector3d center_of_mass(const model::RobotModel& robot, const JointVector& q);

}  // namespace pmg::generator
