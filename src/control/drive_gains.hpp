// The gains that a tick sends to the drives.
#pragma once

#include "hal/command_guard.hpp"
#include "model/robot_model.hpp"
#include "policy/policy.hpp"

namespace pmg::control {

policy::DriveGains own_gains(const model::RobotModel& robot);  ///< robot.yaml's

/// The policy's gains, or robot.yaml's where it has none. Throws std::invalid_argument for gains that don't fit the
/// robot or exceed the guard's largest: the bus guard would clamp them in silence.
policy::DriveGains gains_in_force(const model::RobotModel& robot, const policy::Policy& policy,
                                  const hal::GuardOptions& guard);

}  // namespace pmg::control
