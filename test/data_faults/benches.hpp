// Benches for the search for data faults: random joints, with recorded speeds and feed-forward where that matters.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "calib/single_joint.hpp"
#include "diagnosis/random_bench.hpp"

namespace pmg::test {

/// Plays every run again with the bench's truth, with white noise of the readings, and records the speed.
inline void play(RandomBench& made, unsigned seed, double noise_rad = 3e-4) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_rad);
  const double step_s = 0.001;
  for (bench::BenchRun& run : made.runs) {
    const std::vector<double> q_rad = calib::SingleJoint(made.bench, run, step_s).rollout(made.truth);
    bench::Recording& r = run.recording;
    r.q_rad = q_rad;
    r.dq_rad_s.assign(q_rad.size(), 0.0);
    for (std::size_t k = 1; k + 1 < q_rad.size(); ++k)
      r.dq_rad_s[k] = (q_rad[k + 1] - q_rad[k - 1]) / (r.t_s[k + 1] - r.t_s[k - 1]);
    for (double& value : r.q_rad) value += noise(random);
  }
}

/// A position PD on a pendulum that records its speed.
inline RandomBench bench_with_speed(unsigned seed) {
  RandomBench made = random_bench(seed);
  play(made, seed);
  return made;
}

/// A cascade of so many Nm per volt, whose feed-forward is a third of the load's weight, at another pace in every run.
inline RandomBench cascade_bench(unsigned seed) {
  RandomBench made = random_bench(seed);
  std::mt19937 random(seed + 1000);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double torque_per_volt_Nm = 4.0 + 30.0 * unit(random);
  made.bench.law = bench::DriveLaw::kCascadePd;
  for (auto* drive : {&made.bench.known.drive, &made.truth.actuator.drive}) {
    drive->torque_per_unit_Nm = torque_per_volt_Nm;
    drive->limit = drive->limit / torque_per_volt_Nm;
  }
  for (bench::BenchRun& run : made.runs) {
    run.kp /= torque_per_volt_Nm;
    run.kd /= torque_per_volt_Nm;
    const double pace_rad_s = 4.0 + 6.0 * unit(random);
    for (const double t_s : run.recording.t_s)
      run.recording.tau_ff_Nm.push_back(0.33 * run.load.gravity_Nm * std::sin(pace_rad_s * t_s));
  }
  play(made, seed);
  return made;
}

/// Every run twice, with other noise.
inline RandomBench with_repeats(RandomBench made, unsigned seed) {
  const std::size_t runs = made.runs.size();
  for (std::size_t i = 0; i < runs; ++i) {
    bench::BenchRun again = made.runs[i];
    again.file = "again_" + again.file;
    again.repeat = 1;
    made.runs.push_back(again);
    // Runs of random_bench have commands of their own: only the two are a condition.
    made.runs[i].trajectory = made.runs.back().trajectory = made.runs[i].file;
  }
  play(made, seed, 1e-3);
  return made;
}

inline RandomBench repeated_bench(unsigned seed) { return with_repeats(random_bench(seed), seed); }

/// A drive that is commanded torques: those of the load's weight and inertia along a planned motion, on two loads.
inline RandomBench torque_bench(unsigned seed) {
  RandomBench made = random_bench(seed);
  made.bench.law = bench::DriveLaw::kTorque;
  made.bench.known.transmission.armature_kg_m2 = made.truth.actuator.transmission.armature_kg_m2;
  std::mt19937 random(seed + 2000);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (bench::BenchRun& run : made.runs) {
    run.kp = 1.0, run.kd = 0.0;
    bench::Recording& r = run.recording;
    const double reach_rad = 0.5 + 0.5 * unit(random), pace_rad_s = 2.0 + 3.0 * unit(random);
    const double friction_Nm = made.truth.actuator.friction.coulomb_Nm;
    const double inertia_kg_m2 = run.load.inertia_kg_m2 + made.truth.actuator.transmission.armature_kg_m2;
    r.torque_Nm.clear();
    for (std::size_t k = 0; k < r.t_s.size(); ++k) {
      const double t_s = r.t_s[k], soft = 1.0 - std::exp(-t_s);  // from rest
      const double q_rad = soft * reach_rad * std::sin(pace_rad_s * t_s);
      const double dq_rad_s = soft * reach_rad * pace_rad_s * std::cos(pace_rad_s * t_s);
      r.q_cmd_rad[k] = q_rad;
      r.torque_Nm.push_back(run.load.gravity_Nm * std::sin(q_rad) - inertia_kg_m2 * pace_rad_s * pace_rad_s * q_rad +
                            friction_Nm * std::tanh(dq_rad_s / 0.05));
    }
    r.enabled.clear();
  }
  play(made, seed);
  for (bench::BenchRun& run : made.runs) run.recording.dq_rad_s.clear();
  return made;
}

}  // namespace pmg::test
