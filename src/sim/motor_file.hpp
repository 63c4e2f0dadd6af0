// motor.yaml: the calibrated actuators of a robot or a bench, joint by joint.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "model/actuator_parameters.hpp"
#include "model/joint_index.hpp"

namespace pmg::sim {

/// Actuators by joint name. Parameters that a file doesn't give are neutral.
using ActuatorsByJoint = std::map<std::string, model::ActuatorParameters>;

/// Throws files::ConfigError with file, line and column on unknown groups and keys, and on numbers that make no sense.
ActuatorsByJoint read_motor_file(const std::filesystem::path& file);

/// The same; every name must also be a joint of the robot.
ActuatorsByJoint read_motor_file(const std::filesystem::path& file, const model::JointIndex& joints);

/// The text from which read_motor_file reads the same numbers: all parameters that are not neutral. The remarks become
/// comments at its top.
std::string motor_yaml(const ActuatorsByJoint& actuators, const std::vector<std::string>& remarks = {});

}  // namespace pmg::sim
