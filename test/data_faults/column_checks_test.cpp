// Columns that follow from other columns, checked without a fitted model.
#include "data_faults/column_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pmg::data_faults {
namespace {

constexpr double kSample_s = 0.01;

/// Smooth motion of a stiff drive that holds every command for a sample: a robot's knee, with the torque that the drive
/// gives.
bench::BenchRun stiff_run(double kp_Nm_per_rad, double kd_Nm_s_per_rad, double pace_rad_s, double factor) {
  constexpr double kStep_s = 1e-4, kInertia_kg_m2 = 0.17, kViscous_Nm_s_per_rad = 0.3;
  constexpr int kSteps = 100, kSamples = 500;
  bench::BenchRun run;
  run.file = "sines_" + std::to_string(static_cast<int>(10.0 * kp_Nm_per_rad + pace_rad_s)) + ".csv";
  run.kp = kp_Nm_per_rad;
  run.kd = kd_Nm_s_per_rad;
  bench::Recording& r = run.recording;
  double q_rad = 0.0, dq_rad_s = 0.0, held_rad = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const double t_s = kSample_s * k;
    const auto torque_Nm = [&] { return kp_Nm_per_rad * (held_rad - q_rad) - kd_Nm_s_per_rad * dq_rad_s; };
    r.t_s.push_back(t_s);
    r.q_rad.push_back(q_rad);
    r.q_cmd_rad.push_back(0.4 * std::sin(pace_rad_s * t_s) + 0.1 * std::sin(2.7 * pace_rad_s * t_s));
    r.torque_Nm.push_back(factor * torque_Nm());  // under the command before: the new one isn't in force yet
    r.valid.push_back(true);
    held_rad = r.q_cmd_rad.back();
    for (int j = 0; j < kSteps; ++j) {
      dq_rad_s += kStep_s * (torque_Nm() - kViscous_Nm_s_per_rad * dq_rad_s) / kInertia_kg_m2;
      q_rad += kStep_s * dq_rad_s;
    }
  }
  return run;
}

std::vector<DataFault> found_in(double factor) {
  bench::Bench bench;
  bench.sample_rate_hz = 1.0 / kSample_s;
  bench.law = bench::DriveLaw::kPositionPd;
  bench.known.drive.limit = 1e3;
  std::vector<bench::BenchRun> runs;
  for (const double kp_Nm_per_rad : {350.0, 700.0}) {
    for (const double pace_rad_s : {4.0, 6.0, 9.0}) runs.push_back(stiff_run(kp_Nm_per_rad, 16.0, pace_rad_s, factor));
  }
  return derived_column_faults(bench, runs, {}, 0.0);
}

TEST(ColumnChecks, ASoundTorqueUnderHeldCommandsHasNoFault) {
  const std::vector<DataFault> found = found_in(1.0);
  EXPECT_TRUE(found.empty()) << found.front().correction << "; " << found.front().evidence.front();
}

TEST(ColumnChecks, ATurnedTorqueUnderHeldCommandsIsNamed) {
  const std::vector<DataFault> found = found_in(-1.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().kind, Kind::kSign);
  EXPECT_TRUE(found.front().files.empty()) << "of all runs";
}

}  // namespace
}  // namespace pmg::data_faults
