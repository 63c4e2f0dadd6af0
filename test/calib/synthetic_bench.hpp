// Benches made up for tests: one joint, moved by a given model, its recordings in memory or in files.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "calib/single_joint.hpp"

namespace pmg::test {

/// Steps and smooth segments within +-1.2 rad, 3 s at 100 Hz; another phase and pace for each number.
inline bench::Recording excitation(int number) {
  bench::Recording recording;
  for (int k = 0; k < 300; ++k) {
    const double t_s = 0.01 * k, pace = 1.0 + 0.4 * number;
    const double smooth_rad = 0.8 * std::sin(2.0 * pace * t_s) + 0.3 * std::sin(7.0 * t_s + number);
    const double step_rad = t_s < 1.8 ? 0.9 : -0.4;
    recording.t_s.push_back(t_s);
    recording.q_cmd_rad.push_back(t_s < 0.1 ? 0.0 : t_s < 1.2 ? smooth_rad : step_rad);
    recording.q_rad.push_back(0.0);
    recording.valid.push_back(true);
  }
  return recording;
}

/// A rotor, some viscous friction and this much dry friction.
inline calib::JointModel plain_joint(double coulomb_Nm) {
  calib::JointModel model;
  model.actuator.transmission.armature_kg_m2 = 0.01;
  model.actuator.friction.viscous_Nm_s_per_rad = 0.1;
  model.actuator.friction.coulomb_Nm = coulomb_Nm;
  return model;
}

/// A position PD on a horizontal axis or a pendulum.
inline bench::Bench pd_bench(bool pendulum) {
  bench::Bench bench;
  bench.folder = "synthetic";
  bench.rig = pendulum ? bench::Rig::kPendulum : bench::Rig::kHorizontal;
  bench.law = bench::DriveLaw::kPositionPd;
  return bench;
}

/// Runs of the bench as the model moves them, with noise of the sensor; simulated with the step, or with the one that
/// fits use.
inline std::vector<calib::SingleJoint> record(const bench::Bench& bench, const calib::JointModel& truth, int count,
                                              double noise_rad = 0.0, unsigned seed = 1, double step_s = 0.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  const bool pendulum = bench.rig == bench::Rig::kPendulum;
  std::vector<calib::SingleJoint> joints;
  for (int number = 0; number < count; ++number) {
    bench::BenchRun run;
    run.file = fmt::format("run{}.csv", number);
    run.trajectory = fmt::format("excitation{}", number);
    run.place = (number + 0.5) / count;
    run.kp = number % 2 == 0 ? 20.0 : 40.0;
    run.kd = number < 2 ? 0.8 : 1.6;  // of one kd alone nothing tells it from viscous friction
    run.load = {0.02 + 0.01 * number, pendulum ? 1.0 + 0.5 * number : 0.0, 0.0};
    run.recording = excitation(number);
    const calib::SingleJoint joint(bench, run, step_s > 0.0 ? step_s : calib::simulation_step_s(bench));
    run.recording.q_rad = joint.rollout(truth);
    for (double& q_rad : run.recording.q_rad) q_rad += noise_rad * noise(random);
    joints.emplace_back(bench, run, calib::simulation_step_s(bench));
  }
  return joints;
}

/// The same runs under sines that never rest.
inline std::vector<calib::SingleJoint> always_moving(const bench::Bench& bench, const calib::JointModel& truth,
                                                     int count) {
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : record(bench, truth, count)) {
    bench::BenchRun run = joint.run();
    for (std::size_t k = 0; k < run.recording.t_s.size(); ++k)
      run.recording.q_cmd_rad[k] = std::sin((3.0 + 0.5 * run.load.gravity_Nm) * run.recording.t_s[k]);
    run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
    joints.emplace_back(bench, run, joint.step_s());
  }
  return joints;
}

/// The bench and its runs as files, as a bench engineer would have them.
inline void write_bench(const std::filesystem::path& folder, const std::vector<calib::SingleJoint>& joints) {
  std::filesystem::create_directories(folder / "runs");
  std::ofstream yaml(folder / "bench.yaml");
  yaml << "rig: pendulum\nunits: {q: rad, t: s}\nsample_rate_hz: 100\ndrive:\n  law: position_pd\nloads:\n";
  std::ofstream rows(folder / "runs.csv");
  rows << "file,trajectory,repeat,kp_Nm_per_rad,kd_Nm_s_per_rad,load_mass_kg\n";
  std::map<double, double> masses_kg;  // by the load's inertia, which differs from load to load
  for (const calib::SingleJoint& joint : joints) {
    const bench::BenchRun& run = joint.run();
    const auto [load, fresh] =
        masses_kg.try_emplace(run.load.inertia_kg_m2, 1.0 + static_cast<double>(masses_kg.size()));
    const double mass_kg = load->second;
    if (fresh) {
      yaml << fmt::format("  - {{mass_kg: {}, length_m: 0.1, inertia_kg_m2: {}, gravity_Nm: {}}}\n", mass_kg,
                          run.load.inertia_kg_m2, run.load.gravity_Nm);
    }
    rows << fmt::format("{},{},{},{},{},{}\n", run.file, run.trajectory, run.repeat, run.kp, run.kd, mass_kg);
    std::ofstream csv(folder / "runs" / run.file);
    const bench::Recording& r = run.recording;
    csv << "t_s,q_cmd_rad,q_rad" << (r.enabled.empty() ? "\n" : ",enabled\n");
    for (std::size_t k = 0; k < r.t_s.size(); ++k) {
      csv << fmt::format("{},{},{}", r.t_s[k], r.q_cmd_rad[k], r.q_rad[k]);
      csv << (r.enabled.empty() ? "\n" : r.enabled[k] ? ",1\n" : ",0\n");
    }
  }
}

}  // namespace pmg::test
