#include "bench/odd_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/noise_floor.hpp"
#include "calib/synthetic_bench.hpp"

namespace pmg::bench {
namespace {

constexpr double kWhite_rad = 2e-3;

/// So many repeats of two trajectories at four gains; each gain follows the command a little further. White noise.
class OddRuns : public testing::Test {
 protected:
  void record(int repeats) {
    for (int number = 0; number < 8; ++number) {
      const int gain = number / 2;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        BenchRun run;
        run.trajectory = std::to_string(number % 2);
        run.kp = 10.0 + gain;
        run.repeat = repeat;
        run.file = run.trajectory + "_kp" + std::to_string(gain) + "_r" + std::to_string(repeat);
        run.recording = test::excitation(number % 2);
        for (std::size_t k = 0; k < run.recording.q_rad.size(); ++k)
          run.recording.q_rad[k] = (0.90 + 0.02 * gain) * run.recording.q_cmd_rad[k] + noise();
        runs_.push_back(run);
      }
    }
  }
  double noise() { return kWhite_rad * normal_(random_); }

  BenchRun& run(const std::string& file) {
    return *std::find_if(runs_.begin(), runs_.end(), [&](const BenchRun& one) { return one.file == file; });
  }
  /// The joint stays where it is after 0.5 s, as one that is blocked.
  void stall(const std::string& file) {
    std::vector<double>& q_rad = run(file).recording.q_rad;
    for (std::size_t k = 50; k < q_rad.size(); ++k) q_rad[k] = q_rad[49] + noise();
  }
  /// A drive that hunts at 4 Hz, each time with another phase.
  void hunt(const std::string& file, double amplitude_rad) {
    const double phase_rad = 6.283 * std::uniform_real_distribution<double>()(random_);
    Recording& r = run(file).recording;
    for (std::size_t k = 0; k < r.q_rad.size(); ++k)
      r.q_rad[k] += amplitude_rad * std::sin(25.1 * r.t_s[k] + phase_rad);
  }
  NoiseFloor floor() const {
    std::vector<const BenchRun*> pointers;
    for (const BenchRun& one : runs_) pointers.push_back(&one);
    return noise_floor(pointers);
  }

  std::mt19937 random_{1};
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::vector<BenchRun> runs_;
};

TEST_F(OddRuns, OneAmongThreeRepeatsIsNamedAndLeftOutAndDoesNotMoveTheFloor) {
  record(3);
  EXPECT_TRUE(floor().odd_runs.empty());
  stall("0_kp1_r2");
  stall("1_kp3_r0");
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 2U);
  EXPECT_EQ(found.odd_runs[0].run, "0_kp1_r2");
  EXPECT_EQ(found.odd_runs[1].run, "1_kp3_r0");
  for (const OddRun& odd : found.odd_runs) {
    EXPECT_TRUE(odd.left_out);
    EXPECT_GT(odd.deviation_rad, 0.2);
    EXPECT_NE(odd.why.find("differs from 2 other repeats"), std::string::npos) << odd.why;
  }
  EXPECT_NEAR(found.rms_rad, kWhite_rad, 0.07 * kWhite_rad);  // the tolerance of NoiseFloor's own test
}

TEST_F(OddRuns, AnOddRunInEveryConditionDoesNotMoveTheFloorEither) {
  record(3);
  for (int number = 0; number < 8; ++number)
    stall(std::to_string(number % 2) + "_kp" + std::to_string(number / 2) + "_r1");
  const NoiseFloor found = floor();
  EXPECT_EQ(found.odd_runs.size(), 8U);
  EXPECT_NEAR(found.rms_rad, kWhite_rad, 0.07 * kWhite_rad);
}

TEST_F(OddRuns, OfTwoRepeatsTheOtherConditionsDecide) {
  record(2);
  stall("1_kp2_r0");
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 1U);
  EXPECT_EQ(found.odd_runs[0].run, "1_kp2_r0");
  EXPECT_TRUE(found.odd_runs[0].left_out);
  EXPECT_NEAR(found.rms_rad, kWhite_rad, 0.07 * kWhite_rad);
}

TEST_F(OddRuns, WhereTheOtherConditionsDoNotDecideBothAreNamedAndStay) {
  record(2);
  for (double& q_rad : run("1_kp2_r0").recording.q_rad) q_rad += 0.2;  // a horn that slipped, one way
  for (double& q_rad : run("1_kp2_r1").recording.q_rad) q_rad -= 0.2;  // and the other
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 2U);
  EXPECT_EQ(found.odd_runs[0].run, "1_kp2_r0");
  EXPECT_EQ(found.odd_runs[1].run, "1_kp2_r1");
  for (const OddRun& odd : found.odd_runs) EXPECT_FALSE(odd.left_out) << odd.why;
}

TEST_F(OddRuns, AConditionThatIsMerelyNoisyHasNone) {
  for (const int repeats : {2, 3, 4}) {
    runs_.clear();
    record(repeats);
    for (int repeat = 0; repeat < repeats; ++repeat) hunt("0_kp3_r" + std::to_string(repeat), 0.06);
    const NoiseFloor found = floor();
    EXPECT_TRUE(found.odd_runs.empty()) << repeats << " repeats: " << found.odd_runs.front().why;
    EXPECT_NEAR(found.rms_rad, kWhite_rad, 0.07 * kWhite_rad);
  }
}

TEST_F(OddRuns, AMotionThatIsLateIsOddWhereTheOthersAgreeAsRepeatsDo) {
  record(3);
  Recording& late = run("0_kp1_r1").recording;  // it oscillates as the others do, and so does the difference
  for (int number = 0; number < 8; ++number) {
    for (int repeat = 0; repeat < 3; ++repeat) {
      Recording& r =
          run(std::to_string(number % 2) + "_kp" + std::to_string(number / 2) + "_r" + std::to_string(repeat))
              .recording;
      for (std::size_t k = 0; k < r.q_rad.size(); ++k)
        r.q_rad[k] = 0.8 * std::sin(25.1 * (r.t_s[k] - (&r == &late ? 0.1 : 0.0))) + noise();
    }
  }
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 1U);
  EXPECT_EQ(found.odd_runs[0].run, "0_kp1_r1");
}

TEST_F(OddRuns, ATrajectoryThatIsNoisierThanTheOtherHasNone) {
  record(3);
  for (BenchRun& one : runs_) {  // its readings start anew in each run
    const double start_rad = 10.0 * noise();
    if (one.trajectory == "1") {
      for (double& q_rad : one.recording.q_rad) q_rad += start_rad;
    }
  }
  const NoiseFloor found = floor();
  EXPECT_TRUE(found.odd_runs.empty()) << found.odd_runs.front().why;
}

TEST_F(OddRuns, CopiesAreNamedAndDoNotPullTheFloorDown) {
  record(5);
  for (int number = 0; number < 8; ++number) {
    const std::string condition = std::to_string(number % 2) + "_kp" + std::to_string(number / 2) + "_r";
    for (const char* copy : {"1", "2", "3"})
      run(condition + copy).recording.q_rad = run(condition + "0").recording.q_rad;
  }
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 24U);
  for (const OddRun& odd : found.odd_runs) {
    EXPECT_NE(odd.why.find("is a copy of"), std::string::npos) << odd.why;
    EXPECT_FALSE(odd.left_out);
  }
  EXPECT_NEAR(found.rms_rad, kWhite_rad, 0.07 * kWhite_rad);
}

TEST_F(OddRuns, ARunWithoutRepeatsIsNamedWhereItDisagreesWithAllOthers) {
  record(1);
  EXPECT_TRUE(floor().odd_runs.empty());
  stall("1_kp2_r0");
  const NoiseFloor found = floor();
  ASSERT_EQ(found.odd_runs.size(), 1U);
  EXPECT_EQ(found.odd_runs[0].run, "1_kp2_r0");
  EXPECT_FALSE(found.odd_runs[0].left_out);
}

}  // namespace
}  // namespace pmg::bench
