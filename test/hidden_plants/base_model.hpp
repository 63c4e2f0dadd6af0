// What a bench engineer knows before anything is wrong: the healthy joint, calibrated with the project's own model.
#pragma once

#include <filesystem>

#include "model/actuator_parameters.hpp"
#include "rig.hpp"

namespace pmg::hidden {

/// The rig's numbers as the actuator model has them: where a calibration begins.
model::ActuatorParameters nominal_model(const Rig& rig);

/// The nominal model with gains, rotor, known friction and delay fitted to recordings of the healthy joint.
model::ActuatorParameters calibrated_model(const Rig& rig, const std::filesystem::path& healthy_bench);

}  // namespace pmg::hidden
