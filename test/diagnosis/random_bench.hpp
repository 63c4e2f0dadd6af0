// Benches of a joint with random strength, gains, loads, friction and noise, for how often a check is right and wrong.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"

namespace pmg::test {

struct RandomBench {
  bench::Bench bench;
  calib::JointModel truth;
  std::vector<bench::BenchRun> runs;
};

/// The command of one run within +-reach_rad, T_s long: steps, two sines, a chirp, or a slow triangle.
inline std::vector<double> random_command(std::mt19937& random, int kind, double rate_hz, double T_s) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double reach_rad = 0.6 + 0.6 * unit(random), phase = 6.28 * unit(random), pace = 0.7 + unit(random);
  std::vector<double> steps_rad{0.0};
  for (int i = 0; i < 8; ++i) steps_rad.push_back(reach_rad * (2.0 * unit(random) - 1.0));
  std::vector<double> command_rad;
  for (int k = 0; k < static_cast<int>(T_s * rate_hz); ++k) {
    const double t_s = k / rate_hz;
    double value_rad = 0.0;
    if (kind == 0) value_rad = steps_rad[static_cast<std::size_t>(t_s / 0.9)];
    if (kind == 1) {
      value_rad = 0.6 * std::sin(3.0 * pace * t_s + phase) + 0.4 * std::sin(7.3 * pace * t_s);
      value_rad -= 0.6 * std::sin(phase);
    }
    if (kind == 2) value_rad = std::sin((2.0 + 1.5 * t_s) * t_s * pace);
    if (kind == 3) value_rad = 2.0 / std::numbers::pi * std::asin(std::sin(2.0 * pace * t_s));
    command_rad.push_back(kind == 0 ? value_rad : reach_rad * value_rad);
  }
  return command_rad;
}

/// A position PD on a pendulum or without gravity, or a voltage servo on a pendulum.
enum class Kind { kPendulum, kHorizontal, kServo };

/// change: plants an effect. Base: Coulomb and viscous friction.
inline RandomBench random_bench(unsigned seed, const std::function<void(RandomBench&, std::mt19937&)>& change = {},
                                Kind kind = Kind::kPendulum) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
  RandomBench made;
  made.bench.folder = "random";
  const bool pendulum = kind != Kind::kHorizontal, servo = kind == Kind::kServo;
  made.bench.rig = pendulum ? bench::Rig::kPendulum : bench::Rig::kHorizontal;
  made.bench.law = servo ? bench::DriveLaw::kServoVoltage : bench::DriveLaw::kPositionPd;
  made.bench.sample_rate_hz = unit(random) < 0.5 ? 100.0 : 250.0;
  const double torque_Nm = between(1.0, 6.0);
  made.truth.actuator.friction.coulomb_Nm = torque_Nm * between(0.02, 0.15);
  made.truth.actuator.friction.viscous_Nm_s_per_rad = torque_Nm * between(0.005, 0.03);
  made.truth.actuator.transmission.armature_kg_m2 = torque_Nm * between(0.002, 0.01);
  const double noise_rad = between(0.2e-3, 1.5e-3), strongest_Nm = torque_Nm * between(2.5, 4.0);
  const double kp = servo ? between(1.0, 3.0) : torque_Nm * between(5.0, 15.0),
               kd = servo ? 0.0 : kp * between(0.02, 0.05);
  made.bench.known.drive.limit = made.truth.actuator.drive.limit = servo ? 1.0 : strongest_Nm;
  if (servo) {
    made.bench.supply_V = 12.0;
    made.truth.actuator.drive.torque_per_unit_Nm = strongest_Nm / made.bench.supply_V;
    made.truth.actuator.drive.back_emf_s_per_rad = made.bench.supply_V / between(5.0, 9.0);
  }
  if (change) change(made, random);
  std::normal_distribution<double> noise(0.0, noise_rad);
  for (int i = 0; i < 12; ++i) {
    bench::BenchRun run;
    run.file = "run" + std::to_string(i) + ".csv";
    run.trajectory = std::to_string(i % 4);
    run.kp = (i + i / 4) % 2 == 0 ? kp : 2.0 * kp;
    run.kd = i % 3 == 0 ? kd : 1.6 * kd;
    const double size = i % 5 < 3 ? 1.0 : 1.6;
    run.load = {0.04 * torque_Nm * size, pendulum ? torque_Nm * size : 0.0};
    bench::Recording& r = run.recording;
    r.q_cmd_rad = random_command(random, i % 4, made.bench.sample_rate_hz, 5.0);
    for (std::size_t k = 0; k < r.q_cmd_rad.size(); ++k) {
      r.t_s.push_back(static_cast<double>(k) / made.bench.sample_rate_hz);
      r.enabled.push_back(i % 4 != 3 || r.t_s.back() < 2.6);  // slow triangles end in a free swing
      r.temp_C.push_back(25.0 + 1.5 * i + 0.3 * r.t_s.back());
    }
    r.q_rad.assign(r.t_s.size(), 0.0);
    r.valid.assign(r.t_s.size(), true);
    const calib::SingleJoint joint(made.bench, run, 0.001);
    r.q_rad = joint.rollout(made.truth);
    const double quantum_rad = made.truth.actuator.sensor.quantum_rad;
    for (double& q_rad : r.q_rad) {
      q_rad += noise(random);
      if (quantum_rad > 0.0) q_rad = quantum_rad * std::round(q_rad / quantum_rad);
    }
    made.runs.push_back(run);
  }
  return made;
}

}  // namespace pmg::test
