#include "bench/excitation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "bench/bench.hpp"
#include "temporary_folder.hpp"

namespace pmg::bench {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const ExcitationLimits kLimits{
    .lower_rad = -0.3, .upper_rad = 0.9, .speed_rad_s = 2.0, .rate_hz = 100.0, .seconds = 8.0};
const std::vector<ExcitationGains> kGains = {{60.0, 2.0}, {30.0, 2.0}, {30.0, 1.0}};

class ExcitationFiles : public testing::Test {
 protected:
  std::string refusal() const {
    try {
      read_excitation(folder_);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "";
  }
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("an excitation");
};

TEST(Excitation, OfARobotsJointStaysWellWithinItsRangeAndHasTwoDampings) {
  model::Joint joint;
  joint.lower_rad = -0.2, joint.upper_rad = 2.0, joint.stand_rad = 0.4, joint.velocity_limit_rad_s = 9.0;
  joint.kp_Nm_per_rad = 80.0, joint.kd_Nm_s_per_rad = 2.0;
  const ExcitationLimits limits = excitation_limits(joint, kLimits);
  EXPECT_DOUBLE_EQ(limits.lower_rad, 0.1) << "half of the way to the nearer end";
  EXPECT_DOUBLE_EQ(limits.upper_rad, 0.7);
  EXPECT_DOUBLE_EQ(limits.speed_rad_s, 3.0);
  EXPECT_EQ(limits.rate_hz, kLimits.rate_hz);
  joint.lower_rad = -3.0, joint.upper_rad = 3.0;
  EXPECT_DOUBLE_EQ(excitation_limits(joint).upper_rad, 0.9) << "half a radian at most";
  const std::vector<ExcitationGains> gains = excitation_gains(joint);
  EXPECT_EQ(gains.front().kp_Nm_per_rad, 80.0);
  EXPECT_NE(gains.front().kd_Nm_s_per_rad, gains.back().kd_Nm_s_per_rad);
}

TEST(Excitation, StaysWithinItsLimitsAndBeginsAndEndsAtRest) {
  const Excitation excitation = make_excitation(kLimits, kGains, 2, 1);
  ASSERT_EQ(excitation.trajectories.size(), 5U);
  for (const ExcitationTrajectory& trajectory : excitation.trajectories) {
    const std::vector<double>& q = trajectory.q_cmd_rad;
    EXPECT_NEAR(static_cast<double>(q.size()), 800.0, 2.0) << trajectory.name;
    EXPECT_GE(*std::ranges::min_element(q), -0.3 - 1e-12) << trajectory.name;
    EXPECT_LE(*std::ranges::max_element(q), 0.9 + 1e-12) << trajectory.name;
    for (std::size_t k = 0; k < 49; ++k) {
      EXPECT_DOUBLE_EQ(q[k], 0.3) << trajectory.name;
      EXPECT_DOUBLE_EQ(q[q.size() - 1 - k], 0.3) << trajectory.name;
    }
    if (trajectory.name == "steps" || trajectory.name == "mixed") continue;
    for (std::size_t k = 1; k < q.size(); ++k) {
      EXPECT_LE(std::abs(q[k] - q[k - 1]), 0.02 + 1e-9) << trajectory.name << " at sample " << k;
    }
  }
}

TEST(Excitation, UsesTheAngleAndTheSpeedThatItMay) {
  const Excitation excitation = make_excitation(kLimits, kGains, 1, 1);
  const auto span_rad = [&](const char* name) {
    const auto [low, high] = std::ranges::minmax_element(excitation.trajectory(name).q_cmd_rad);
    return *high - *low;
  };
  const auto fastest_rad_s = [&](const char* name) {
    const std::vector<double>& q = excitation.trajectory(name).q_cmd_rad;
    double fastest = 0.0;
    for (std::size_t k = 1; k < q.size(); ++k) fastest = std::max(fastest, 100.0 * std::abs(q[k] - q[k - 1]));
    return fastest;
  };
  EXPECT_GT(span_rad("steps"), 0.8 * 1.2);
  EXPECT_GT(fastest_rad_s("sweep"), 0.8 * 2.0);
  EXPECT_GT(fastest_rad_s("sines"), 0.4 * 2.0);
  EXPECT_LT(fastest_rad_s("slow"), 0.31 * 2.0) << "creeps";
  EXPECT_GT(fastest_rad_s("mixed"), 10.0) << "has steps";
}

TEST(Excitation, GivesEveryTrajectoryEveryPairOfGainsAndIsTheSameEveryTime) {
  const Excitation excitation = make_excitation(kLimits, kGains, 2, 1), again = make_excitation(kLimits, kGains, 2, 1);
  EXPECT_EQ(excitation.rows.size(), 5U * 3U * 2U);
  std::set<std::string> files;
  for (const ExcitationRow& row : excitation.rows) files.insert(row.file);
  EXPECT_EQ(files.size(), excitation.rows.size());
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(excitation.trajectories[i].q_cmd_rad, again.trajectories[i].q_cmd_rad);
  }
  EXPECT_NE(make_excitation(kLimits, kGains, 1, 2).trajectories[0].q_cmd_rad, again.trajectories[0].q_cmd_rad);
}

TEST(Excitation, RefusesLimitsAndGainsThatMakeNoSense) {
  ExcitationLimits backwards = kLimits, still = kLimits, brief = kLimits;
  backwards.upper_rad = -1.0;
  still.speed_rad_s = 0.0;
  brief.seconds = 1.0;
  for (const ExcitationLimits& limits : {backwards, still, brief}) {
    EXPECT_THROW(make_excitation(limits, kGains, 1, 1), std::invalid_argument);
  }
  EXPECT_THROW(make_excitation(kLimits, {}, 1, 1), std::invalid_argument);
  EXPECT_THROW(make_excitation(kLimits, {{-1.0, 0.0}}, 1, 1), std::invalid_argument);
  EXPECT_THROW(make_excitation(kLimits, kGains, 0, 1), std::invalid_argument);
}

TEST_F(ExcitationFiles, ARecordedBenchIsToldThatItIsOne) {
  fs::create_directories(folder_ / "runs");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("is a recorded bench"), HasSubstr("--make-excitation")));
}

TEST_F(ExcitationFiles, AreReadBackAndAreABenchWithoutRecordings) {
  const Excitation excitation = make_excitation(kLimits, kGains, 2, 1);
  write_excitation(folder_, excitation, "made by a test");
  const Excitation read = read_excitation(folder_);
  EXPECT_DOUBLE_EQ(read.rate_hz, 100.0);
  ASSERT_EQ(read.rows.size(), excitation.rows.size());
  EXPECT_EQ(read.rows[7].file, excitation.rows[7].file);
  EXPECT_EQ(read.rows[7].gains.kd_Nm_s_per_rad, excitation.rows[7].gains.kd_Nm_s_per_rad);
  for (const ExcitationTrajectory& trajectory : excitation.trajectories) {
    EXPECT_EQ(read.trajectory(trajectory.name).q_cmd_rad, trajectory.q_cmd_rad);
  }
  EXPECT_EQ(read_bench(folder_).runs.rows.size(), excitation.rows.size());
  EXPECT_THROW(write_excitation(folder_, excitation, ""), std::runtime_error) << "a bench isn't overwritten";
}

TEST_F(ExcitationFiles, AreRefusedWithPlaceAndReason) {
  write_excitation(folder_, make_excitation(kLimits, kGains, 1, 1), "made by a test");
  std::ofstream(folder_ / "commands" / "sines.csv") << "t_s,q_cmd_rad\n0,0\n0.01,0\n0.05,0\n";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("sines.csv:4"), HasSubstr("t_s")));
  fs::remove(folder_ / "commands" / "sines.csv");
  EXPECT_THAT(refusal(), HasSubstr("sines.csv"));
  std::ofstream(folder_ / "runs.csv") << "file,trajectory,repeat,kp_Nm_per_rad,kd_Nm_s_per_rad\na.csv,steps,0,much,1\n";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("runs.csv:2"), HasSubstr("kp_Nm_per_rad")));
}

}  // namespace
}  // namespace pmg::bench
