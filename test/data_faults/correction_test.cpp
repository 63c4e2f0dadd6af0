#include "bench/correction.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "bench/bench.hpp"
#include "calib/synthetic_bench.hpp"

namespace pmg::bench {
namespace {

BenchRun run_with_ramp() {
  BenchRun run;
  run.file = "a.csv";
  run.kp = 10.0;
  run.load = {0.02, 1.5};
  for (int k = 0; k < 100; ++k) {
    run.recording.t_s.push_back(0.01 * k);
    run.recording.q_cmd_rad.push_back(0.1 * k);
    run.recording.q_rad.push_back(0.1 * k);
    run.recording.valid.push_back(k != 50);
  }
  return run;
}

TEST(Correction, MultipliesTheColumnsThatItNames) {
  BenchRun run = run_with_ramp();
  correct(run, {.columns = {Column::kPosition}, .factor = -1.0});
  EXPECT_DOUBLE_EQ(run.recording.q_rad[7], -0.7);
  EXPECT_DOUBLE_EQ(run.recording.q_cmd_rad[7], 0.7);
}

TEST(Correction, LeavesOtherRunsAlone) {
  BenchRun run = run_with_ramp();
  correct(run, {.files = {"b.csv"}, .columns = {Column::kPosition}, .factor = -1.0, .kp_factor = 2.0});
  EXPECT_DOUBLE_EQ(run.recording.q_rad[7], 0.7);
  EXPECT_DOUBLE_EQ(run.kp, 10.0);
}

TEST(Correction, MovesAColumnAndCutsWhatIsUnknown) {
  BenchRun run = run_with_ramp();
  correct(run, {.columns = {Column::kPosition}, .shift_s = 0.05});
  ASSERT_EQ(run.recording.t_s.size(), 95U) << "the last 0.05 s have no reading";
  EXPECT_EQ(run.recording.q_rad.size(), 95U);
  EXPECT_NEAR(run.recording.q_rad[10], 1.5, 1e-9) << "the reading of 0.05 s later";
  EXPECT_NEAR(run.recording.q_cmd_rad[10], 1.0, 1e-9);
  EXPECT_FALSE(run.recording.valid[45]) << "the dropout moves along";
}

TEST(Correction, GivesARowOtherGainsAndLoad) {
  BenchRun run = run_with_ramp();
  correct(run, {.conditions =
                    RowConditions{.trajectory = "steps", .repeat = 1, .kp = 20.0, .kd = 0.5, .load = {0.04, 3.0}}});
  EXPECT_EQ(run.trajectory, "steps");
  EXPECT_DOUBLE_EQ(run.kp, 20.0);
  EXPECT_DOUBLE_EQ(run.load.gravity_Nm, 3.0);
  correct(run, {.kp_factor = 0.5, .load_factor = 2.0});
  EXPECT_DOUBLE_EQ(run.kp, 10.0);
  EXPECT_DOUBLE_EQ(run.load.gravity_Nm, 6.0);
  EXPECT_DOUBLE_EQ(run.load.inertia_kg_m2, 0.08);
}

TEST(Correction, LeavesOutReadingsAndJoinsThoseBeside) {
  BenchRun run = run_with_ramp();
  for (std::size_t k = 48; k < 53; ++k) run.recording.q_rad[k] = 9.0;  // 50 is a dropout
  correct(run, {.unknown_readings = {48, 49, 51, 52}});
  for (std::size_t k = 47; k < 54; ++k) {
    EXPECT_EQ(run.recording.valid[k], k < 48 || k > 52) << k;
    if (k == 50) continue;
    EXPECT_NEAR(run.recording.q_rad[k], 0.1 * static_cast<double>(k), 1e-12) << k;
  }
  correct(run, {.unknown_readings = {98, 99}});
  EXPECT_FALSE(run.recording.valid[99]) << "there is nothing on the other side";
}

TEST(Correction, ABenchReadsItsRunsCorrectedAndWithoutThoseLeftOut) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("pmg_correction_" + std::to_string(getpid()));
  calib::JointModel truth;
  truth.actuator.friction.viscous_Nm_s_per_rad = 0.1;
  test::write_bench(folder, test::record(test::pd_bench(true), truth, 3));
  const Bench bench = read_bench(folder);
  const Bench mended =
      corrected(bench, {{.files = {"run1.csv"}, .columns = {Column::kPosition}, .factor = -1.0}}, {"run0.csv"});
  const std::vector<BenchRun> before = bench.read_runs(RowFilter("")), after = mended.read_runs(RowFilter(""));
  ASSERT_EQ(before.size(), 3U);
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after[0].file, "run1.csv");
  EXPECT_DOUBLE_EQ(after[0].recording.q_rad[100], -before[1].recording.q_rad[100]);
  EXPECT_DOUBLE_EQ(after[1].recording.q_rad[100], before[2].recording.q_rad[100]);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pmg::bench
