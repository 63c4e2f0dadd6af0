// The group residual_torque of motor.yaml.
#pragma once

#include <string>

#include "files/config_reader.hpp"
#include "model/residual_torque.hpp"

namespace pmg::model {

/// (mapping of one joint in motor.yaml) => (its residual torque; no term without the group). Throws files::ConfigError.
ResidualTorque read_residual_torque(files::ConfigReader& joint);

/// The group's text, indented as a group of a joint; "" without a term. read_residual_torque reads the same numbers.
std::string residual_torque_yaml(const ResidualTorque& torque);

}  // namespace pmg::model
