// The benches that the plants stand on: machines, drive laws, gains, loads, commands, and what disturbs a recording.
#pragma once

#include <string>
#include <vector>

#include "machine.hpp"
#include "randomness.hpp"

namespace pmg::literature {

struct Gains {
  double kp = 0.0, kd = 0.0;  ///< Nm/rad and Nm s/rad; a servo's firmware number; a cascade's V/rad and V s/rad
};

struct Load {
  double mass_kg = 0.0, length_m = 0.0, inertia_kg_m2 = 0.0, gravity_Nm = 0.0;  ///< as weighed
};

/// One value a sample period.
struct Trajectory {
  std::string name;
  std::vector<double> q_rad, dq_rad_s, ddq_rad_s2;
  double released_s = 0.0;  ///< at the end the drive is switched off for so long
};

struct RunDesign {
  std::size_t gains = 0, load = 0, trajectory = 0;
  int repeat = 0;
  bool scored = false;
  bool asked_for = false;  ///< by a diagnosis, and recorded after the session
};

enum class NoiseForm { kWhite, kLaplace, kHum, kWander };

/// What makes two recordings of one run differ.
struct Noise {
  NoiseForm form = NoiseForm::kWhite;
  double sensor_rad = 3e-4;                    ///< rms
  double push_Nm = 0.02, push_corner_s = 0.1;  ///< rms of a slow random torque on the load, its correlation time
  double start_rad = 3e-3;                     ///< rms of where the joint hangs at first
  double jitter = 0.0;                         ///< of the times between samples, as a share of the period
  double clock_share = 0.0;                    ///< by which the host's clock runs fast
  double dropouts_per_s = 0.0;                 ///< single readings that leap away
};

struct Rig {
  Machine healthy;  ///< with the loads' numbers unset
  bool horizontal = false;
  double sample_rate_hz = 200.0, bus_V = 1.0;
  double bus_fall = 0.0;  ///< share that the battery loses over the session
  std::vector<Gains> gains;
  std::vector<Load> loads;
  std::vector<Trajectory> trajectories;
  std::vector<RunDesign> runs;
  Noise noise;
  std::vector<double> mass_factor;  ///< of each load: truth over what was weighed
  bool records_temperature = false, temperature_in_rows = false, records_bus = false;
  bool commands_speed = false, feeds_forward = false;  ///< columns dq_cmd_rad_s, tau_ff_Nm
  double warms_K = 0.0;                                ///< over the session
  /// What the load weighs, or what it takes to turn it without weight: strengths are shares of this.
  double scale_Nm() const;
  /// Runs of the session: those of the design.
  double session_runs() const;
  double scale_inertia_kg_m2() const { return loads.front().inertia_kg_m2 + healthy.body.rotor_inertia_kg_m2; }
};

/// What a form needs of its rig.
struct RigNeeds {
  unsigned laws = 15;  ///< one bit a law, in the order of Law
  bool weight = false, two_loads = false, warm = false;
};
inline constexpr unsigned kPd = 1, kServoLaw = 2, kCascadeLaw = 4, kTorqueLaw = 8;

/// The needs of both.
RigNeeds both(const RigNeeds& a, const RigNeeds& b);

Rig draw_rig(Draw& draw, const RigNeeds& needs);

/// Steps, minimum-jerk moves, sines, sweeps, strokes and creeping strokes, by their number.
Trajectory draw_trajectory(Draw& draw, std::size_t kind, double rate_hz, bool smooth);
inline constexpr std::size_t kTrajectoryKinds = 6;

/// Speeds and accelerations of its angles.
void differentiate(Trajectory& trajectory, double rate_hz);

/// What the rig feeds forward over a trajectory with that load, in the unit of the drive's output.
std::vector<double> feed_forward(const Rig& rig, const Trajectory& trajectory, const Load& load);

}  // namespace pmg::literature
