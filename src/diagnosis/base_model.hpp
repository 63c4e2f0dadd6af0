// The model that a diagnosis starts from, with the tolerances of its parameters.
#pragma once

#include <optional>

#include "diagnosis/options.hpp"
#include "effects/extension.hpp"

namespace pmg::diagnosis {

using effects::BaseModel;

/// given: parameters of motor.yaml. noise_squares: mean square of the noise [rad^2]. Without a given model the paper's
/// eta and bench.yaml's unknowns are fitted from scratch.
BaseModel base_model(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given,
                     const effects::NestedFit& fit, const JointDiagnosisOptions& options, double noise_squares,
                     unsigned threads);

}  // namespace pmg::diagnosis
