// The model that a diagnosis starts from, with the tolerances of its parameters.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/options.hpp"
#include "effects/nested_fit.hpp"

namespace pmg::diagnosis {

/// The model without further effects. Every extension refits its unknowns, so that an effect gets no credit for a
/// residual that the base model can absorb. Parameters that bench.yaml calls unknown are fitted over their full range,
/// parameters known from a calibration or a data sheet within their tolerance.
struct BaseModel {
  calib::JointModel model;
  std::vector<effects::Unknown> unknowns;
  effects::BenchScale scale;
};

/// given: parameters of motor.yaml. Without them the paper's eta and bench.yaml's unknowns are fitted from scratch.
BaseModel base_model(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given,
                     const effects::NestedFit& fit, const JointDiagnosisOptions& options, unsigned threads);

}  // namespace pmg::diagnosis
