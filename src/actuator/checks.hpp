// Whether an actuator can be simulated.
#pragma once

#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

/// Throws std::invalid_argument that names the parameter if a value makes no sense or a delay is too long for the step.
void expect_simulable(const model::ActuatorParameters& parameters, double step_s);

}  // namespace pmg::actuator
