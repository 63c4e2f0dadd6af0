// The actuator's parameters under the name of the room that simulates it. Rooms that simulate nothing take them from
// model/.
#pragma once

#include "model/actuator_parameters.hpp"

namespace pmg::sim {

using model::actuator_parameter;
using model::actuator_parameters;
using model::ActuatorParameter;
using model::ActuatorParameters;
using model::kReferenceTemperature_C;

}  // namespace pmg::sim
