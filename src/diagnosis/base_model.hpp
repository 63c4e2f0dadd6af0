// What a diagnosis starts from: the model that the simulation has, and how well its numbers are known.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/options.hpp"
#include "effects/nested_fit.hpp"

namespace pmg::diagnosis {

/// The simulation without any further effect. Its unknowns are fitted again with every extension, so that no effect is
/// credited for what the base could have absorbed: in full range what bench.yaml calls unknown, and within their
/// tolerance the numbers that a calibration or a data sheet knows.
struct BaseModel {
  calib::JointModel model;
  std::vector<effects::Unknown> unknowns;
  effects::BenchScale scale;
};

/// given: of motor.yaml; without it the paper's eta and what bench.yaml calls unknown are fitted from scratch.
BaseModel base_model(const bench::Bench& bench, const std::optional<sim::ActuatorParameters>& given,
                     const effects::NestedFit& fit, const JointDiagnosisOptions& options, unsigned threads);

}  // namespace pmg::diagnosis
