// Recordings of a hidden plant, as its bench engineer makes them.
#pragma once

#include <string>
#include <vector>

#include "planting.hpp"

namespace pmg::hidden {

/// One recording, and what it can be repeated from.
struct PlantRecording {
  std::vector<double> t_s, q_cmd_rad, q_rad, temp_C;
  std::vector<bool> enabled;
};

/// What is done with the joint in one run.
struct PlantRun {
  double kp = 0.0, kd = 0.0;
  RigLoad load;              ///< as weighed
  double mass_factor = 1.0;  ///< what the scales didn't see
  RigCommand command;
  double temperature_C = 25.0;
  std::uint64_t stream = 0;  ///< of this run's noise
};

PlantRecording record(const PlantParameters& plant, const Rig& rig, std::uint64_t seed, const PlantRun& run);

/// A run of the rig's own design. take: 0 is the recording; others are the same run on another day.
PlantRun run_of(const HiddenPlant& hidden, std::size_t index, std::uint64_t take = 0);

/// Whether anybody would record this bench: every run stays within half a turn, and most of the time near its command.
bool follows_its_commands(const HiddenPlant& hidden);

/// Mean absolute difference of two recordings of the same commands [rad].
double mean_absolute_difference_rad(const PlantRecording& a, const PlantRecording& b);

}  // namespace pmg::hidden
