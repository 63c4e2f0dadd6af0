// Benches for the search for data faults: random joints, with recorded speeds and feed-forward where that matters.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "calib/single_joint.hpp"
#include "diagnosis/random_bench.hpp"

namespace pmg::test {

/// Plays every run again with the bench's truth, with white noise of the readings, and records the speed.
inline void play(RandomBench& made, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 3e-4);
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

}  // namespace pmg::test
