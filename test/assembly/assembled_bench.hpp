// Benches whose runs come from several assemblies of one joint, in memory.
#pragma once

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "assembly/variation.hpp"
#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"

namespace pmg::assembly {

inline calib::JointModel healthy() { return test::plain_joint(0.3); }

/// One run: the joint as it was assembled, what moved it, and the cells of runs.csv.
struct Made {
  calib::JointModel truth = healthy();
  int trajectory = 0;
  double gravity_Nm = 1.5;
  double amplitude = 1.0;          ///< of the motion
  std::vector<std::string> cells;  ///< of the further columns
};

class AssembledBench {
 public:
  AssembledBench(std::vector<std::string> columns, unsigned seed, double noise_rad = 1e-3)
      : bench_(test::pd_bench(true)), noise_rad_(noise_rad), random_(seed) {
    bench_.runs.header = {"file", "trajectory", "repeat"};
    bench_.runs.header.insert(bench_.runs.header.end(), columns.begin(), columns.end());
  }

  void add(const Made& made) {
    bench::BenchRun run;
    run.file = fmt::format("run{}.csv", runs_.size());
    run.trajectory = fmt::format("excitation{}", made.trajectory);
    run.kp = made.trajectory % 2 == 0 ? 20.0 : 40.0;
    run.kd = 0.8;
    run.load = {0.02 * made.gravity_Nm, made.gravity_Nm, 0.0};
    run.recording = test::excitation(made.trajectory);
    for (double& q_rad : run.recording.q_cmd_rad) q_rad *= made.amplitude;
    run.recording.q_rad = calib::SingleJoint(bench_, run, calib::simulation_step_s(bench_)).rollout(made.truth);
    std::normal_distribution<double> noise(0.0, noise_rad_);
    for (double& q_rad : run.recording.q_rad) q_rad += noise(random_);
    std::vector<std::string> row = {run.file, run.trajectory, "0"};
    row.insert(row.end(), made.cells.begin(), made.cells.end());
    bench_.runs.rows.push_back(row);
    runs_.emplace_back(bench_, run, calib::simulation_step_s(bench_));
  }

  /// The model with one number each for gain of torque, friction and zero offset's like: what a diagnosis would have.
  AssemblyDifferences found(const AssemblyOptions& options = {}, const std::vector<std::string>& further = {}) const {
    const effects::NestedFit fit(runs_, 1);
    const effects::BenchScale scale = effects::scale_of(bench_, runs_, healthy());
    calib::Unknowns unknowns;
    std::vector<std::string> names = {"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad"};
    names.insert(names.end(), further.begin(), further.end());
    for (const std::string& name : names) unknowns.push_back(effects::unknown(name, bench_, scale));
    const effects::NestedModel fitted = fit.fit(healthy(), unknowns, 15);
    return differences_of_assemblies(
        {.bench = bench_, .fit = fit, .fitted = fitted, .neutral = healthy(), .noise_squares = noise_rad_ * noise_rad_},
        options);
  }

  const bench::Bench& bench() const { return bench_; }
  const std::vector<calib::SingleJoint>& runs() const { return runs_; }
  std::vector<const bench::BenchRun*> bench_runs() const {
    std::vector<const bench::BenchRun*> found;
    for (const calib::SingleJoint& joint : runs_) found.push_back(&joint.run());
    return found;
  }

 private:
  bench::Bench bench_;
  double noise_rad_;
  std::mt19937 random_;
  std::vector<calib::SingleJoint> runs_;
};

/// The healthy joint with one parameter changed by an amount.
inline calib::JointModel changed(const std::string& parameter, double amount) {
  calib::JointModel model = healthy();
  calib::set(model, parameter, calib::value(model, parameter) + amount);
  return model;
}

/// An AssembledBench of arms with these amounts of the parameter, `runs` runs of each.
inline AssembledBench arms(const std::string& parameter, const std::vector<double>& amounts, int runs, unsigned seed) {
  AssembledBench made({"arm"}, seed);
  for (std::size_t arm = 0; arm < amounts.size(); ++arm) {
    for (int i = 0; i < runs; ++i)
      made.add({changed(parameter, amounts[arm]),
                i,
                1.0 + 0.5 * (i % 3),
                1.0,
                {std::string(1, static_cast<char>('a' + arm))}});
  }
  return made;
}

}  // namespace pmg::assembly
