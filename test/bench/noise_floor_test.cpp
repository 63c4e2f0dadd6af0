#include "bench/noise_floor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "calib/synthetic_bench.hpp"

namespace pmg::bench {
namespace {

constexpr double kNoise_rad = 2e-3;

/// Two repeats of each of so many designs, with white noise of the sensor.
std::vector<BenchRun> repeated_runs(int designs, double noise_rad) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, noise_rad);
  std::vector<BenchRun> runs;
  for (int design = 0; design < designs; ++design) {
    for (int repeat = 0; repeat < 2; ++repeat) {
      BenchRun run;
      run.trajectory = std::to_string(design);
      run.repeat = repeat;
      run.recording = test::excitation(design);
      run.recording.q_rad = run.recording.q_cmd_rad;
      for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
      runs.push_back(run);
    }
  }
  return runs;
}

std::vector<const BenchRun*> pointers(const std::vector<BenchRun>& runs) {
  std::vector<const BenchRun*> found;
  for (const BenchRun& run : runs) found.push_back(&run);
  return found;
}

TEST(NoiseFloor, IsTheStrayOfOneRecordingAndSqrtTwoOfItBetweenTwo) {
  const std::vector<BenchRun> runs = repeated_runs(6, kNoise_rad);
  const NoiseFloor floor = noise_floor(pointers(runs));
  EXPECT_EQ(floor.pairs.size(), 6);
  // 1800 differences: their standard deviation is known to 1.7 %, four of those.
  EXPECT_NEAR(floor.rms_rad, kNoise_rad, 0.07 * kNoise_rad);
  EXPECT_NEAR(floor.mean_absolute_rad, kNoise_rad * std::sqrt(2.0 / std::numbers::pi), 0.07 * kNoise_rad);
  EXPECT_NEAR(floor.difference_rms_rad, std::sqrt(2.0) * floor.rms_rad, 1e-15);
  EXPECT_LE(floor.mean_absolute_low_rad, floor.mean_absolute_rad);
  EXPECT_GE(floor.mean_absolute_high_rad, floor.mean_absolute_rad);
}

TEST(NoiseFloor, ComparesOnlyRunsOfOneDesignWithTheSameCommand) {
  std::vector<BenchRun> runs = repeated_runs(2, kNoise_rad);
  runs[1].kp = 2.0 * runs[0].kp;
  for (double& command_rad : runs[3].recording.q_cmd_rad) command_rad *= -1.0;
  EXPECT_TRUE(noise_floor(pointers(runs)).pairs.empty());
}

TEST(NoiseFloor, LeavesDropoutsOut) {
  std::vector<BenchRun> runs = repeated_runs(1, kNoise_rad);
  const double before_rad = noise_floor(pointers(runs)).rms_rad;
  runs[0].recording.q_rad[50] = 9.0;
  runs[0].recording.valid[50] = false;
  EXPECT_NEAR(noise_floor(pointers(runs)).rms_rad, before_rad, 0.05 * before_rad);
}

TEST(SensorNoise, IsFoundUnderTheMotion) {
  const std::vector<BenchRun> runs = repeated_runs(10, kNoise_rad);
  double mean_rad = 0.0;
  for (const BenchRun& run : runs) mean_rad += sensor_noise_rad(run.recording) / static_cast<double>(runs.size());
  // The command's three jumps touch 7 % of the differences and lift their median by 12 %.
  EXPECT_NEAR(mean_rad, kNoise_rad, 0.2 * kNoise_rad);
}

}  // namespace
}  // namespace pmg::bench
