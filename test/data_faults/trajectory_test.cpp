// Rows of runs.csv whose trajectory isn't the recorded one, told by the commands alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "data_faults/examine.hpp"
#include "data_faults/trajectory_checks.hpp"

namespace pmg::data_faults {
namespace {

/// Two trajectories, three runs each.
std::vector<bench::BenchRun> six_runs() {
  std::vector<bench::BenchRun> runs(6);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool sine = i < 3;
    runs[i].file = "run" + std::to_string(i) + ".csv";
    runs[i].trajectory = sine ? "sine" : "steps";
    for (int k = 0; k < 300; ++k) {
      const double t_s = 0.01 * k;
      runs[i].recording.q_cmd_rad.push_back(sine ? std::sin(3.0 * t_s) : t_s < 1.5 ? 0.0 : 1.0);
    }
  }
  return runs;
}

TEST(TrajectoryFaults, SoundRowsHaveNone) { EXPECT_TRUE(trajectory_faults(six_runs(), {}).empty()); }

TEST(TrajectoryFaults, ARowWithTheNameOfAnotherTrajectoryIsNamed) {
  std::vector<bench::BenchRun> runs = six_runs();
  runs[1].trajectory = "steps";
  const std::vector<DataFault> found = trajectory_faults(runs, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().kind, Kind::kRow);
  EXPECT_EQ(found.front().files, std::vector<std::string>{"run1.csv"});
  EXPECT_NE(found.front().correction.find("sine, not steps"), std::string::npos) << found.front().correction;
  ASSERT_EQ(found.front().fixes.size(), 1U);
  EXPECT_EQ(found.front().fixes.front().conditions->trajectory, "sine");
}

TEST(TrajectoryFaults, TwoRowsThatStandForEachOtherAreOneFault) {
  std::vector<bench::BenchRun> runs = six_runs();
  std::swap(runs[1].trajectory, runs[4].trajectory);
  const std::vector<DataFault> found = trajectory_faults(runs, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().kind, Kind::kSwappedRuns);
  EXPECT_THAT(found.front().files, testing::UnorderedElementsAre("run1.csv", "run4.csv"));
}

/// Gains and loads of the two rows are the same: without a model only the commands tell.
TEST(TrajectoryFaults, ASearchForAllFaultsFindsThemToo) {
  std::vector<bench::BenchRun> runs = six_runs();
  for (bench::BenchRun& run : runs) {
    run.recording.q_rad = run.recording.q_cmd_rad;
    run.recording.valid.assign(run.recording.q_rad.size(), true);
    for (std::size_t k = 0; k < run.recording.q_rad.size(); ++k)
      run.recording.t_s.push_back(0.01 * static_cast<double>(k));
    run.kp = 20.0;
    run.load = {0.03, 1.0, 0.0};
  }
  bench::Bench bench;
  bench.law = bench::DriveLaw::kPositionPd;
  EXPECT_TRUE(find_data_faults(bench, runs, std::nullopt, {}, 1).empty());
  std::swap(runs[1].trajectory, runs[4].trajectory);
  const std::vector<DataFault> found = find_data_faults(bench, runs, std::nullopt, {}, 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().kind, Kind::kSwappedRuns);
}

}  // namespace
}  // namespace pmg::data_faults
