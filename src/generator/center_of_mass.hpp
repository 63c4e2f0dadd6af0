// The robot's centre of mass, for postures that must not topple.
#pragma once

#include <Eigen/Core>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

/// Centre of mass [m] in the base frame: sum m_i p_i / sum m_i over all links. q: all joints [rad].
Eigen::Vector3d center_of_mass(const model::RobotModel& robot, const JointVector& q);

}  // namespace pmg::generator
