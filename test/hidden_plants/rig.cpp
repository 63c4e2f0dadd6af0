#include "rig.hpp"

#include <algorithm>

namespace pmg::hidden {

namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kQuiet_s = 0.3;  // at first the joint hangs

RigLoad point_mass(double mass_kg, double length_m) {
  return {mass_kg, length_m, mass_kg * length_m * length_m, mass_kg * kGravity_m_s2 * length_m};
}

/// A quasi-direct drive or a geared servo of a small robot's leg.
void draw_joint(Draw& draw, Rig& rig) {
  PlantParameters& p = rig.healthy;
  p.body.rotor_inertia_kg_m2 = draw.spread(0.006, 0.03);
  p.drive.limit = draw.uniform(18.0, 30.0);
  p.friction.coulomb_Nm = draw.spread(0.15, 0.5);
  p.friction.viscous_Nm_s_per_rad = draw.spread(0.04, 0.2);
  const double length_m = draw.uniform(0.18, 0.3), mass_kg = draw.uniform(0.8, 1.8);
  rig.loads = {point_mass(mass_kg, length_m), point_mass(mass_kg * draw.uniform(1.5, 2.0), length_m)};
  const double kp = draw.uniform(18.0, 30.0), ratio = draw.uniform(1.5, 1.8);
  const double inertia = rig.loads.front().inertia_kg_m2 + p.body.rotor_inertia_kg_m2;
  for (int i = 0; i < 3; ++i) {
    const double gain = kp * std::pow(ratio, i);
    rig.gains.push_back({gain, draw.uniform(0.25, 0.5) * 2.0 * std::sqrt(gain * inertia)});
  }
}

/// A hobby servo that takes positions and turns errors into voltage.
void draw_servo(Draw& draw, Rig& rig) {
  PlantParameters& p = rig.healthy;
  p.drive.servo = true;
  rig.bus_V = draw.uniform(11.0, 15.0);
  p.drive.kp_factor = draw.uniform(0.14, 0.19);
  p.drive.torque_Nm_per_V = draw.uniform(0.2, 0.35);
  p.drive.back_emf_V_s_per_rad = draw.uniform(1.0, 1.8);
  p.body.rotor_inertia_kg_m2 = draw.spread(0.008, 0.03);
  p.friction.coulomb_Nm = draw.spread(0.05, 0.15);
  const double length_m = draw.uniform(0.1, 0.16), mass_kg = draw.uniform(0.5, 0.8);
  rig.loads = {point_mass(mass_kg, length_m), point_mass(mass_kg * draw.uniform(1.4, 1.8), length_m)};
  const double kp = draw.uniform(6.0, 10.0), ratio = draw.uniform(1.6, 2.0);
  for (int i = 0; i < 3; ++i) rig.gains.push_back({kp * std::pow(ratio, i), 0.0});
}

/// What a good calibration of the healthy joint has in it besides.
void draw_known_effects(Draw& draw, PlantParameters& p) {
  if (draw.chance(0.3)) {
    p.friction.stribeck_Nm = draw.uniform(0.2, 0.5) * p.friction.coulomb_Nm;
    p.friction.stribeck_rad_s = draw.uniform(0.1, 0.4);
  } else if (draw.chance(0.3)) {
    p.friction.load_driving = draw.uniform(0.05, 0.15);
    p.friction.load_backdriving =
        p.friction.load_driving / (1.0 + p.friction.load_driving);  // one efficiency both ways
  }
  if (draw.chance(0.5)) p.command.delay_s = draw.uniform(0.001, 0.005);
  if (draw.chance(0.5)) p.sensor.quantum_rad = 2.0 * std::numbers::pi / (draw.chance(0.5) ? 4096.0 : 16384.0);
}

/// Towards targets along quintic curves, resting at each.
void append_smooth(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q_rad) {
  while (q_rad.size() < until) {
    const double from_rad = q_rad.back(), to_rad = draw.uniform(-reach_rad, reach_rad);
    const auto moving = static_cast<std::size_t>(draw.uniform(0.25, 0.9) * rate_hz);
    const auto resting = static_cast<std::size_t>(draw.uniform(0.05, 0.4) * rate_hz);
    for (std::size_t k = 1; k <= moving; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(moving);
      q_rad.push_back(from_rad + (to_rad - from_rad) * s * s * s * (10.0 + s * (6.0 * s - 15.0)));
    }
    q_rad.insert(q_rad.end(), resting, to_rad);
  }
  q_rad.resize(until);
}

void append_steps(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q_rad) {
  while (q_rad.size() < until) {
    const double to_rad = draw.uniform(-reach_rad, reach_rad);
    q_rad.insert(q_rad.end(), static_cast<std::size_t>(draw.uniform(0.3, 0.8) * rate_hz), to_rad);
  }
  q_rad.resize(until);
}

void append_sines(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q_rad) {
  const double slow_hz = draw.uniform(0.3, 0.6), middle_hz = draw.uniform(0.9, 1.6), fast_hz = draw.uniform(2.2, 3.5);
  const double start_rad = q_rad.back();
  for (std::size_t k = 1; q_rad.size() < until; ++k) {
    const double t_s = static_cast<double>(k) / rate_hz, turn = 2.0 * std::numbers::pi * t_s;
    q_rad.push_back(start_rad + reach_rad * (0.6 * std::sin(slow_hz * turn) + 0.3 * std::sin(middle_hz * turn) +
                                             0.1 * std::sin(fast_hz * turn)));
  }
}

/// Back and forth at an even pace over growing and shrinking ways.
void append_ramps(Draw& draw, double rate_hz, double reach_rad, std::size_t until, std::vector<double>& q_rad) {
  const double pace_rad_s = draw.uniform(0.5, 1.2);
  double side = draw.sign();
  while (q_rad.size() < until) {
    const double from_rad = q_rad.back(), to_rad = side * draw.uniform(0.2, 1.0) * reach_rad;
    const auto steps = static_cast<std::size_t>(std::abs(to_rad - from_rad) / pace_rad_s * rate_hz) + 1;
    for (std::size_t k = 1; k <= steps; ++k) {
      q_rad.push_back(from_rad + (to_rad - from_rad) * static_cast<double>(k) / static_cast<double>(steps));
    }
    side = -side;
  }
  q_rad.resize(until);
}

RigCommand draw_command(Draw& draw, std::size_t kind, double rate_hz) {
  const double duration_s = draw.uniform(4.0, 6.0), reach_rad = draw.uniform(0.7, 1.1);
  const auto samples = static_cast<std::size_t>(duration_s * rate_hz);
  RigCommand command;
  command.q_rad.assign(static_cast<std::size_t>(kQuiet_s * rate_hz), 0.0);
  switch (kind) {
    case 0:
      command.name = "mixed";
      append_steps(draw, rate_hz, reach_rad, samples / 2, command.q_rad);
      append_smooth(draw, rate_hz, reach_rad, samples, command.q_rad);
      break;
    case 1:
      command.name = "steps";
      append_steps(draw, rate_hz, reach_rad, samples, command.q_rad);
      break;
    case 2:
      command.name = "sines";
      append_sines(draw, rate_hz, reach_rad, samples, command.q_rad);
      break;
    default:
      command.name = "ramps";
      append_ramps(draw, rate_hz, reach_rad, samples, command.q_rad);
      break;
  }
  if (kind <= 1 && draw.chance(0.4)) command.released_s = draw.uniform(0.6, 1.2);
  return command;
}

/// Twelve or sixteen runs, a third to a half of them held out: by repeat or by gain.
void draw_design(Draw& draw, Rig& rig) {
  const std::size_t design = draw.below(3);
  const std::size_t gains = design == 2 ? 3 : 2, loads = design == 1 ? 2 : 1, commands = design == 0 ? 3 : 2;
  rig.gains.resize(gains);
  rig.loads.resize(loads);
  std::vector<std::size_t> others = {1, 2, 3};
  draw.shuffle(others);
  rig.commands.push_back(draw_command(draw, 0, rig.sample_rate_hz));
  for (std::size_t c = 1; c < commands; ++c) {
    rig.commands.push_back(draw_command(draw, others[c - 1], rig.sample_rate_hz));
  }
  for (std::size_t g = 0; g < gains; ++g) {
    for (std::size_t l = 0; l < loads; ++l) {
      for (std::size_t c = 0; c < commands; ++c) {
        for (int repeat = 0; repeat < 2; ++repeat) {
          rig.runs.push_back({g, l, c, repeat, design == 2 ? g == 1 : repeat == 1});
        }
      }
    }
  }
}

void draw_noise(Draw& draw, Rig& rig) {
  RigNoise& n = rig.noise;
  n.sensor_rad = draw.spread(1e-4, 6e-4);
  n.push_Nm = draw.spread(0.003, 0.02) * rig.loads.front().gravity_Nm;
  n.push_corner_s = draw.spread(0.03, 0.3);
  n.start_rad = draw.uniform(0.0, 0.004);
  if (draw.chance(0.5)) n.jitter = draw.uniform(0.02, 0.25);
  if (draw.chance(0.3)) n.dropouts_per_s = draw.uniform(0.05, 0.5);
  for (std::size_t l = 0; l < rig.loads.size(); ++l) rig.mass_factor.push_back(1.0 + n.mass_share * draw.normal());
  rig.records_temperature = draw.chance(0.5);
  rig.warms_K = draw.uniform(3.0, 20.0);
}

}  // namespace

Rig draw_rig(Draw& draw, RigKind kind) {
  Rig rig;
  constexpr double kRates_hz[] = {100.0, 125.0, 200.0, 250.0};
  rig.sample_rate_hz = kRates_hz[draw.below(4)];
  const bool servo = draw.chance(0.4);
  if (kind == RigKind::kServo || (kind == RigKind::kAny && servo))
    draw_servo(draw, rig);
  else
    draw_joint(draw, rig);
  draw_known_effects(draw, rig.healthy);
  draw_design(draw, rig);
  draw_noise(draw, rig);
  return rig;
}

}  // namespace pmg::hidden
