// Causes from equations that are written down by hand.
#include "robot_diagnosis/robot_evidence.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "robot_diagnosis/drive_sampling.hpp"

namespace pmg::robot_diagnosis {
namespace {

TEST(RobotDiagnosisOptions, EveryNumberIsListedWithItsReason) {
  const std::vector<evidence::Option> all = listed(RobotDiagnosisOptions{});
  EXPECT_EQ(all.size(), sizeof(RobotDiagnosisOptions) / sizeof(double));
  std::set<std::string> names;
  for (const evidence::Option& option : all) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_FALSE(option.reason.empty() || option.set_on.empty()) << option.name;
  }
}

// Means over the beginnings, and over the ends, of n steps of a tick.
TEST(DriveSampling, SharesAreThoseOfTheStepsOfATick) {
  for (const int n : {1, 5, 20}) {
    double s = 0.0, speed = 0.0, ends = 0.0;
    for (int k = 0; k < n; ++k) {
      const double at = static_cast<double>(k) / n;
      s += at / n;
      speed += at * (1.0 - at) * (1.0 - at) / n;
      ends += (at + 1.0 / n) / n;
    }
    const DriveSampling sampling{0.01 / n, ""};
    EXPECT_NEAR(sampling.position_share(0.01), s, 1e-12);
    EXPECT_NEAR(sampling.speed_share(0.01), speed, 1e-12);
    EXPECT_NEAR(sampling.acceleration_share(0.01), ends, 1e-12);
  }
  EXPECT_EQ(DriveSampling{}.position_share(0.01), 0.5) << "a drive much faster than the tick";
}

TEST(DriveSampling, IsTheLogsOwnOrTheSimulatedDrivesOrSaidToBeUnknown) {
  EXPECT_EQ(drive_sampling("ethercat", R"({"drive_sampling_s": 0.001})").step_s, 0.001);
  EXPECT_EQ(drive_sampling("sil", "{}").step_s, 0.002);
  const DriveSampling unknown = drive_sampling("can", "");
  EXPECT_EQ(unknown.step_s, 0.0);
  EXPECT_NE(drive_sampling_text(unknown).find("'can' doesn't say"), std::string::npos);
}

}  // namespace
}  // namespace pmg::robot_diagnosis
