// What a bench engineer knows before anything is wrong: the healthy joint, calibrated with the project's own model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/actuator_parameters.hpp"

namespace pmg::literature {

/// A parameter of motor.yaml that the calibration fits, and the size of a usual change.
struct CalibratedParameter {
  std::string name;
  double scale;
};

/// Fits the parameters to the bench's fitted rows by Levenberg-Marquardt from the model given, so that what the plant's
/// simulation and the project's do differently is in the model as it would be in a real calibration.
model::ActuatorParameters calibrated(model::ActuatorParameters model, const std::vector<CalibratedParameter>& sought,
                                     const std::filesystem::path& healthy_bench, int iterations);

/// Mean absolute error [rad] of the model's rollouts over the rows that the filter keeps.
double rollout_error_rad(const model::ActuatorParameters& model, const std::filesystem::path& bench,
                         const std::string& filter);

}  // namespace pmg::literature
