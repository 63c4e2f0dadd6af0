// motor.yaml: what calibration found of a robot's (or a bench's) actuators, joint by joint.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "model/joint_index.hpp"
#include "sim/actuator_parameters.hpp"

namespace pmg::sim {

/// Actuators by joint name. What a file doesn't say is neutral.
using ActuatorsByJoint = std::map<std::string, ActuatorParameters>;

/// Throws model::ConfigError on unknown groups and keys, and on numbers outside what makes sense, with file, line,
/// column.
ActuatorsByJoint read_motor_file(const std::filesystem::path& file);

/// The same, and every name must be a joint of the robot.
ActuatorsByJoint read_motor_file(const std::filesystem::path& file, const model::JointIndex& joints);

/// The text that read_motor_file reads back to the same numbers: what differs from neutral. The remarks become comments
/// at its top.
std::string motor_yaml(const ActuatorsByJoint& actuators, const std::vector<std::string>& remarks = {});

}  // namespace pmg::sim
