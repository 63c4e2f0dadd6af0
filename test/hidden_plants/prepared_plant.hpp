// A hidden plant made ready to be diagnosed: its bench and what is known of the healthy joint as files, and the truth.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/actuator_parameters.hpp"
#include "planting.hpp"

namespace pmg::hidden {

/// What was planted, with the numbers that a diagnosis should find, and how much of it shows.
struct PlantedTruth {
  struct Effect {
    std::string name;
    double moves_floors = 0.0;  ///< by how many noise floors it moves the held-out error of the model without it
    std::vector<std::pair<std::string, double>> parameters;  ///< of motor.yaml
    std::vector<std::string> same_here;  ///< effects that are the same torque on this rig, whatever is done with it
  };
  std::uint64_t seed = 0;
  PlantKind kind = PlantKind::kClean;
  std::vector<Effect> effects;
  double floor_rad = 0.0;          ///< mean absolute difference of held-out runs from their own repeats
  double healthy_error_rad = 0.0;  ///< of the calibrated model on the healthy joint's held-out runs
  double error_rad = 0.0;          ///< and on the plant's
};

nlohmann::json json(const PlantedTruth& truth);

struct PreparedPlant {
  HiddenPlant hidden;
  model::ActuatorParameters base;  ///< the healthy joint's calibration
  PlantedTruth truth;
  std::filesystem::path bench;
};

/// Writes FOLDER/bench, FOLDER/base.yaml (what pmg_diagnose --model reads) and FOLDER/truth.json, apart from the bench.
PreparedPlant prepare(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace pmg::hidden
