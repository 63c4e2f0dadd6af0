// A plant made ready to be diagnosed: its bench and what is known of the healthy joint as files, and the truth.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/actuator_parameters.hpp"
#include "planting.hpp"

namespace pmg::literature {

struct PreparedPlant {
  LiteraturePlant plant;
  model::ActuatorParameters base;  ///< the healthy joint's calibration
  /// seed, kind, law, effects: [{effect, form, source, moves_floors, parameters, same_here, besides}],
  /// faults: [{kind, column, runs, factor, shift_samples, moves_floors, same_here}], noise_floor_rad,
  /// healthy_error_rad, warms_K, records_temperature.
  nlohmann::json truth;
  std::filesystem::path bench;
};

/// By how many noise floors the effect moves the readings: the mean absolute difference of the held-out recordings of
/// the machine with it and without it, under the same commands and noise, over the noise floor.
double moves_floors(const LiteraturePlant& plant, const Machine& without, double floor_rad);

/// Mean absolute difference of held-out recordings from their own repeats on another day [rad].
double noise_floor_rad(const LiteraturePlant& plant);

/// Writes FOLDER/bench, FOLDER/base.yaml (what pmg_diagnose --model reads) and FOLDER/truth.json, apart from the bench.
PreparedPlant prepare(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace pmg::literature
