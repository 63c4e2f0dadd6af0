// Curves of people's gait: read from files, and compared with others.
#include "generator/gait_norms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "files/config_error.hpp"
#include "refusal.hpp"
#include "temporary_folder.hpp"

namespace pmg::generator {
namespace {

using testing::HasSubstr;

TEST(GaitNorms, ATiltedPelvisIsTakenOffTheHipBecauseTheNormsAreTheThighs) {
  JointVector q = JointVector::Zero(6);
  q << -30.0, 1.0, 2.0, 40.0, -15.0, 3.0;  // the order of LegRole
  q *= std::numbers::pi / 180.0;
  const auto flexed = flexions_deg(q, {0, 1, 2, 3, 4, 5}, 10.0 * std::numbers::pi / 180.0);
  EXPECT_NEAR(flexed[kHip], 20.0, 1e-9);
  EXPECT_NEAR(flexed[kKneeFlexion], 40.0, 1e-9);
  EXPECT_NEAR(flexed[kAnkle], 15.0, 1e-9);
}

TEST(GaitNorms, AnOffsetSpoilsTheRmsButNeitherCorrelationNorShape) {
  std::vector<double> published, ours;
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    published.push_back(20.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / kCyclePoints));
    ours.push_back(published.back() + 5.0);
  }
  const CurveAgreement a = agreement(ours, published);
  EXPECT_NEAR(a.correlation, 1.0, 1e-12);
  EXPECT_NEAR(a.rms_deg, 5.0, 1e-9);
  EXPECT_NEAR(a.shape_rms_deg, 0.0, 1e-9);
  for (double& value : ours) value = -value;
  EXPECT_NEAR(agreement(ours, published).correlation, -1.0, 1e-12);
}

class NormsFile : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(file_) << text; }
  std::string refusal() {
    return test::refusal_by<files::ConfigError>([&] { load_norms(file_); });
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("norms.csv");
};

constexpr const char* kHeader =
    "# source\npct_cycle,pelvis_tilt_ant+_mean,hip_flexion+_mean,hip_flexion+_sd,knee_flexion+_mean,"
    "ankle_dorsiflexion+_mean\n";

TEST_F(NormsFile, AnyEqualStepsAreTakenAndPelvicTiltIsOffTheHip) {
  std::string text = kHeader;
  for (int row = 0; row <= 10; ++row) text += std::to_string(10 * row) + ",12," + std::to_string(12 + row) + ",1,7,3\n";
  write(text);
  const GaitNorms norms = load_norms(file_);
  EXPECT_NEAR(norms.deg[kHip][0], 0.0, 1e-12);
  EXPECT_NEAR(norms.deg[kHip][50], 5.0, 1e-12);
  EXPECT_NEAR(norms.deg[kHip][55], 5.5, 1e-12);
  EXPECT_EQ(norms.deg[kKneeFlexion][99], 7.0);
}

TEST_F(NormsFile, WhatIsWrongIsNamed) {
  EXPECT_THAT(refusal(), HasSubstr("cannot be read"));
  std::string few_columns = "pct_cycle,hip_flexion_mean\n";
  for (int row = 0; row <= 10; ++row) few_columns += std::to_string(row) + ",1\n";
  write(few_columns);
  EXPECT_THAT(refusal(), HasSubstr(":1: knee_flexion..._mean: is missing"));
  write(std::string(kHeader) + "0,1,2,3,4,5\n");
  EXPECT_THAT(refusal(), HasSubstr("1 rows"));
  std::string text = std::string(kHeader) + "0,1,2,3,four,5\n";
  for (int row = 1; row <= 10; ++row) text += "0,1,2,3,4,5\n";
  write(text);
  EXPECT_THAT(refusal(), HasSubstr(":3: knee_flexion+_mean: is 'four'"));
}

TEST(GaitNorms, BuiltInNormsAreThoseOfWalking) {
  const GaitNorms norms = built_in_norms();
  const auto& knee = norms.deg[kKneeFlexion];
  const auto peak = std::max_element(knee.begin(), knee.end()) - knee.begin();
  EXPECT_GT(peak, 65) << "the knee bends most in swing";
  EXPECT_LT(peak, 80);
  EXPECT_GT(norms.deg[kHip].front(), norms.deg[kHip][50]) << "flexed at contact, extended when the other foot lands";
}

}  // namespace
}  // namespace pmg::generator
