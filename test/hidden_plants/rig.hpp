// The benches that hidden plants stand on: machines, gains, loads, commands and what disturbs a recording.
#pragma once

#include <string>
#include <vector>

#include "blind_plants/randomness.hpp"
#include "plant_parameters.hpp"

namespace pmg::hidden {

struct RigGains {
  double kp = 0.0, kd = 0.0;  ///< Nm/rad and Nm s/rad, or a servo firmware's number
};

struct RigLoad {
  double mass_kg = 0.0, length_m = 0.0, inertia_kg_m2 = 0.0, gravity_Nm = 0.0;  ///< as weighed
};

struct RigCommand {
  std::string name;
  std::vector<double> q_rad;  ///< one a sample period
  double released_s = 0.0;    ///< at the end the drive is switched off for so long
};

/// One recording to make.
struct RigRun {
  std::size_t gains = 0, load = 0, command = 0;
  int repeat = 0;
  bool scored = false;
};

/// What makes two recordings of one run differ.
struct RigNoise {
  double sensor_rad = 3e-4;     ///< white
  double push_Nm = 0.02;        ///< rms of a slow random torque on the load
  double push_corner_s = 0.1;   ///< its correlation time
  double start_rad = 5e-3;      ///< rms of where the joint hangs at first
  double jitter = 0.0;          ///< of the times between samples, as a share of the period
  double dropouts_per_s = 0.0;  ///< single readings that leap away
  double mass_share = 0.001;    ///< rms by which the scales are wrong
};

struct Rig {
  PlantParameters healthy;  ///< with the loads' numbers unset
  double sample_rate_hz = 200.0, bus_V = 1.0;
  std::vector<RigGains> gains;
  std::vector<RigLoad> loads;
  std::vector<RigCommand> commands;
  std::vector<RigRun> runs;
  RigNoise noise;
  bool records_temperature = false;
  double warms_K = 0.0;             ///< over the whole session
  std::vector<double> mass_factor;  ///< of each load: truth over what was weighed
};

enum class RigKind { kAny, kPositionPd, kServo };

/// Another bench for each seed. wide: steps large enough to reach a motor's limits.
Rig draw_rig(Draw& draw, RigKind kind);

}  // namespace pmg::hidden
