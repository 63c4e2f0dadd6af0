#include "rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pmg::literature {

namespace {

constexpr double kUsual_rad_s2 = 20.0;  // acceleration of a load that nothing weighs down

/// A disc on an arm: more inertia than a point mass.
Load disc(Draw& draw, double mass_kg, double length_m) {
  const double radius_m = draw.uniform(0.02, 0.05);
  return {mass_kg, length_m, mass_kg * (length_m * length_m + 0.5 * radius_m * radius_m),
          mass_kg * kGravity_m_s2 * length_m};
}

void draw_loads(Draw& draw, Rig& rig, double mass_kg, double length_m) {
  rig.loads = {disc(draw, mass_kg, length_m),
               disc(draw, mass_kg * draw.uniform(1.4, 2.1), length_m * draw.uniform(0.9, 1.1))};
}

/// From a wrist to a knee.
void draw_position_pd(Draw& draw, Rig& rig) {
  Machine& m = rig.healthy;
  draw_loads(draw, rig, draw.spread(0.5, 3.0), draw.uniform(0.12, 0.32));
  m.body.rotor_inertia_kg_m2 = draw.spread(0.15, 0.8) * rig.loads.front().inertia_kg_m2;
  const double weight_Nm = rig.loads.front().gravity_Nm;
  m.drive.limit = draw.uniform(6.0, 12.0) * weight_Nm;
  m.drive.loop_hz = draw.chance(0.5) ? 2000.0 : 4000.0;
  m.friction.coulomb_Nm = draw.spread(0.05, 0.2) * weight_Nm;
  m.friction.viscous_Nm_s_per_rad = draw.spread(0.01, 0.06) * weight_Nm;
  const double kp = draw.uniform(6.0, 12.0) * weight_Nm, ratio = draw.uniform(1.4, 1.9);
  for (int i = 0; i < 3; ++i) {
    const double gain = kp * std::pow(ratio, i);
    rig.gains.push_back({gain, draw.uniform(0.25, 0.55) * 2.0 * std::sqrt(gain * rig.scale_inertia_kg_m2())});
  }
  rig.commands_speed = draw.chance(0.3);
  rig.feeds_forward = draw.chance(0.4);
}

/// Hobby servos that take positions and turn errors into voltage.
void draw_servo(Draw& draw, Rig& rig) {
  Machine& m = rig.healthy;
  rig.bus_V = draw.uniform(6.0, 15.0);
  draw_loads(draw, rig, draw.uniform(0.4, 1.0), draw.uniform(0.09, 0.17));
  const double weight_Nm = rig.loads.front().gravity_Nm;
  m.drive.limit = 1.0;
  m.drive.loop_hz = draw.chance(0.5) ? 1000.0 : 2000.0;
  m.drive.torque_per_unit = draw.uniform(3.5, 6.0) * weight_Nm / rig.bus_V;
  m.drive.back_emf = rig.bus_V / draw.uniform(6.0, 10.0);  // the speed without load
  m.drive.kp_factor = draw.uniform(0.1, 0.2);
  m.body.rotor_inertia_kg_m2 = draw.spread(0.3, 1.5) * rig.loads.front().inertia_kg_m2;
  m.friction.coulomb_Nm = draw.spread(0.05, 0.15) * weight_Nm;
  const double kp = draw.uniform(0.8, 1.4) / m.drive.kp_factor, ratio = draw.uniform(1.5, 2.2);
  for (int i = 0; i < 3; ++i) rig.gains.push_back({kp * std::pow(ratio, i), 0.0});
  rig.records_bus = draw.chance(0.3);
  rig.bus_fall = rig.records_bus ? draw.uniform(0.02, 0.1) : 0.0;
}

/// A position loop around a speed loop in volts, at the rate at which it is recorded.
void draw_cascade(Draw& draw, Rig& rig) {
  Machine& m = rig.healthy;
  rig.sample_rate_hz = draw.chance(0.5) ? 250.0 : 500.0;
  draw_loads(draw, rig, draw.uniform(0.6, 2.5), draw.uniform(0.12, 0.28));
  m.body.rotor_inertia_kg_m2 = draw.spread(0.2, 1.0) * rig.loads.front().inertia_kg_m2;
  const double weight_Nm = rig.loads.front().gravity_Nm;
  m.drive.limit = 10.0;
  m.drive.loop_hz = rig.sample_rate_hz;
  m.drive.torque_per_unit = draw.uniform(0.5, 1.0) * weight_Nm;
  m.friction.coulomb_Nm = draw.spread(0.05, 0.2) * weight_Nm;
  m.friction.viscous_Nm_s_per_rad = draw.spread(0.01, 0.06) * weight_Nm;
  for (int i = 0; i < 3; ++i) {
    const double kv = draw.uniform(20.0, 30.0) * std::pow(1.3, i) * rig.scale_inertia_kg_m2() / m.drive.torque_per_unit;
    rig.gains.push_back({draw.uniform(6.0, 10.0) * kv, kv});
  }
  rig.commands_speed = draw.chance(0.3);
}

/// A motor that is commanded torques computed beforehand; the recorded torque is the input.
void draw_torque(Draw& draw, Rig& rig) {
  draw_position_pd(draw, rig);
  rig.gains.assign(3, {0.0, 0.0});
  rig.commands_speed = rig.feeds_forward = false;
}

/// What a good calibration of the healthy joint has in it besides.
void draw_known_effects(Draw& draw, Rig& rig) {
  Machine& m = rig.healthy;
  const bool holds_position = m.drive.law != Law::kTorque;  // without, stick-slip never goes the same way twice
  if (holds_position && draw.chance(0.3)) {
    m.friction.stribeck_Nm = draw.uniform(0.2, 0.5) * m.friction.coulomb_Nm;
    m.friction.stribeck_rad_s = draw.uniform(0.15, 0.5);
  } else if (!rig.horizontal && draw.chance(0.25)) {
    m.friction.load_form = LoadForm::kTransmitted;
    m.friction.load_driving = m.friction.load_backdriving = draw.uniform(0.05, 0.12);
  }
  if (m.drive.law != Law::kCascade && draw.chance(0.5)) m.command.delay_s = draw.uniform(0.001, 0.006);
  if (draw.chance(0.5)) m.sensor.quantum_rad = 2.0 * std::numbers::pi / (draw.chance(0.5) ? 4096.0 : 16384.0);
}

/// Twelve or sixteen runs, a third to a half of them held out: by repeat, by gain or by trajectory.
void draw_design(Draw& draw, Rig& rig, const RigNeeds& needs) {
  const bool torque = rig.healthy.drive.law == Law::kTorque;
  const bool two_loads = torque || needs.two_loads || draw.chance(0.4);
  const std::size_t gains = torque ? 1 : two_loads || draw.chance(0.5) ? 2 : 3;
  const std::size_t loads = two_loads ? 2 : 1;
  const std::size_t trajectories = gains * loads >= 3 ? 2 : 3;
  rig.gains.resize(gains);
  rig.loads.resize(loads);
  std::vector<std::size_t> others = {1, 2, 3, 4, 5};
  if (torque) others.pop_back();  // nothing creeps evenly under a torque
  draw.shuffle(others);
  const bool smooth = torque || rig.commands_speed;
  for (std::size_t t = 0; t < trajectories; ++t) {
    rig.trajectories.push_back(draw_trajectory(draw, t == 0 ? 0 : others[t - 1], rig.sample_rate_hz, smooth));
  }
  const std::size_t held_out = gains == 3 && draw.chance(0.5) ? 1 : trajectories == 3 && draw.chance(0.15) ? 2 : 0;
  for (std::size_t g = 0; g < gains; ++g) {
    for (std::size_t l = 0; l < loads; ++l) {
      for (std::size_t t = 0; t < trajectories; ++t) {
        for (int repeat = 0; repeat < 2; ++repeat) {
          const bool scored = held_out == 1 ? g == 1 : held_out == 2 ? t == trajectories - 1 : repeat == 1;
          rig.runs.push_back({g, l, t, repeat, scored});
        }
      }
    }
  }
}

void draw_noise(Draw& draw, Rig& rig) {
  Noise& n = rig.noise;
  n.form = static_cast<NoiseForm>(draw.below(4));
  n.sensor_rad = draw.spread(1e-4, 6e-4);
  n.push_Nm = draw.spread(0.003, 0.02) * rig.scale_Nm();
  n.push_corner_s = draw.spread(0.03, 0.3);
  n.start_rad = draw.uniform(0.0, 0.004);
  if (rig.healthy.drive.law != Law::kCascade && draw.chance(0.5)) n.jitter = draw.uniform(0.02, 0.25);
  const bool own_clock = rig.healthy.drive.law != Law::kCascade;  // a cascade records its own ticks
  if (own_clock && draw.chance(0.3)) n.clock_share = 1e-4 * draw.normal();
  if (draw.chance(0.3)) n.dropouts_per_s = draw.uniform(0.05, 0.5);
  for (std::size_t l = 0; l < rig.loads.size(); ++l) rig.mass_factor.push_back(1.0 + 0.001 * draw.normal());
}

/// As many benches get warm without consequence as with one: half of all, by as much.
void draw_temperature(Draw& draw, Rig& rig, const RigNeeds& needs) {
  const bool warm = draw.chance(0.5) || needs.warm;
  rig.records_temperature = needs.warm || draw.chance(0.6);
  rig.temperature_in_rows = draw.chance(0.3);
  rig.warms_K = warm ? draw.uniform(25.0, 55.0) : draw.uniform(0.0, 8.0);
}

}  // namespace

double Rig::scale_Nm() const { return horizontal ? kUsual_rad_s2 * scale_inertia_kg_m2() : loads.front().gravity_Nm; }

double Rig::session_runs() const {
  return static_cast<double>(std::count_if(runs.begin(), runs.end(), [](const RunDesign& r) { return !r.asked_for; }));
}

RigNeeds both(const RigNeeds& a, const RigNeeds& b) {
  return {a.laws & b.laws, a.weight || b.weight, a.two_loads || b.two_loads, a.warm || b.warm};
}

Rig draw_rig(Draw& draw, const RigNeeds& needs) {
  constexpr unsigned kLaws[] = {kPd, kPd, kPd, kServoLaw, kServoLaw, kServoLaw, kCascadeLaw, kCascadeLaw, kTorqueLaw};
  if ((needs.laws & 15U) == 0) throw std::invalid_argument("no drive law has what both effects need");
  unsigned law = 0;
  do {
    law = kLaws[draw.below(std::size(kLaws))];
  } while ((law & needs.laws) == 0);
  Rig rig;
  constexpr double kRates_hz[] = {100.0, 125.0, 200.0, 250.0};
  rig.sample_rate_hz = kRates_hz[draw.below(4)];
  rig.healthy.drive.law = law == kPd           ? Law::kPositionPd
                          : law == kServoLaw   ? Law::kServo
                          : law == kCascadeLaw ? Law::kCascade
                                               : Law::kTorque;
  if (law == kPd) draw_position_pd(draw, rig);
  if (law == kServoLaw) draw_servo(draw, rig);
  if (law == kCascadeLaw) draw_cascade(draw, rig);
  if (law == kTorqueLaw) draw_torque(draw, rig);
  const bool level = draw.chance(0.25);
  rig.horizontal = level && !needs.weight && law != kTorqueLaw;
  if (rig.horizontal) rig.feeds_forward = false;
  draw_known_effects(draw, rig);
  draw_design(draw, rig, needs);
  draw_noise(draw, rig);
  draw_temperature(draw, rig, needs);
  return rig;
}

/// Inverse dynamics of what the bench knows: all of it where the torque is the command, weight elsewhere.
std::vector<double> feed_forward(const Rig& rig, const Trajectory& t, const Load& load) {
  std::vector<double> torque_Nm(t.q_rad.size(), 0.0);
  const bool torque = rig.healthy.drive.law == Law::kTorque;
  if (!torque && !rig.feeds_forward) return torque_Nm;
  const Machine::Friction& f = rig.healthy.friction;
  for (std::size_t k = 0; k < torque_Nm.size(); ++k) {
    torque_Nm[k] = load.gravity_Nm * std::sin(t.q_rad[k]);
    if (!torque) continue;
    torque_Nm[k] += (load.inertia_kg_m2 + rig.healthy.body.rotor_inertia_kg_m2) * t.ddq_rad_s2[k] +
                    f.viscous_Nm_s_per_rad * t.dq_rad_s[k] + f.coulomb_Nm * std::tanh(t.dq_rad_s[k] / 0.05);
  }
  return torque_Nm;
}

}  // namespace pmg::literature
