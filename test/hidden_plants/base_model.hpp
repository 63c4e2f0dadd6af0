// What a bench engineer knows before anything is wrong: the healthy joint, calibrated with the project's own model.
#pragma once

#include <filesystem>
#include <vector>

#include "calib/single_joint.hpp"
#include "rig.hpp"

namespace pmg::hidden {

/// The rig's numbers as the actuator model has them: where a calibration begins.
model::ActuatorParameters nominal_model(const Rig& rig);

/// Fits gains, rotor, known friction and delay to recordings of the healthy joint (Levenberg-Marquardt from the nominal
/// model), so that what the two simulations do differently is in the model as it would be in a real calibration.
model::ActuatorParameters calibrated_model(const Rig& rig, const std::filesystem::path& healthy_bench);

/// Mean absolute error [rad] of the model's rollouts over the rows that the filter keeps.
double rollout_error_rad(const model::ActuatorParameters& model, const std::filesystem::path& bench,
                         const std::string& filter);

}  // namespace pmg::hidden
