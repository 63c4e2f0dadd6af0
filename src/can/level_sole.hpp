// A sole that lies level tells how the motors above it are connected. A foot weighs less than its ankle's friction
// holds, so wiggle leaves an ankle to the eye; a level board under the foot needs no torque.
#pragma once

#include <Eigen/Core>

#include "can/bus_setup.hpp"
#include "can/first_light.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

/// The sole beyond the motor's joint lies level, whatever it says: of all ways to connect the joint's motor, or its
/// linkage's motors, those are left with which the model's sole is level, too. q: what robot.yaml makes of the drives'
/// positions [rad]; down_B: gravity's direction in the base's axes. Throws std::invalid_argument where no sole is
/// beyond the joint, std::runtime_error where no cranks' angles belong to q.
Verdict verdict_of_level_sole(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                              const drives::MotorSetup& motor, const Eigen::Vector3d& down_B);

}  // namespace pmg::can
