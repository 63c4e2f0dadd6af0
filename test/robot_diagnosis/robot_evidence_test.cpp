// Causes from equations that are written down by hand.
#include "robot_diagnosis/robot_evidence.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "robot_diagnosis/drive_sampling.hpp"
#include "robot_diagnosis/robot_samples.hpp"

namespace pmg::robot_diagnosis {
namespace {

constexpr int kStandingKind = 0, kHangingKind = 1, kKinds = 2;

RobotParameterList two_payloads() {
  using Kind = RobotParameter::Kind;
  RobotParameterList list;
  for (const char* link : {"pelvis", "torso"}) {
    list.candidates.push_back({"payload", link, {static_cast<int>(list.parameters.size())}});
    list.parameters.push_back(
        {.kind = Kind::kTorsoMass, .link = link, .tolerance = 0.03, .wide = 3.0, .relevant = 0.25});
  }
  return list;
}

/// The first payload is 1 kg. Standing both act alike; hanging the second acts a little more or less than the first.
std::vector<RobotBlock> blocks_that_begin_standing() {
  constexpr double kNoise_Nm = 0.1, kApart_Nm_per_kg = 0.015;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, kNoise_Nm);
  std::vector<RobotBlock> blocks(6);
  for (RobotBlock& block : blocks) {
    for (int i = 0; i < 45; ++i) {
      const bool standing = i < 5;
      const double apart = standing ? 0.0 : i % 2 == 0 ? kApart_Nm_per_kg : -kApart_Nm_per_kg;
      RobotRow row;
      row.kind = standing ? kStandingKind : kHangingKind;
      row.support = standing ? Support::kStanding : Support::kHanging;
      row.coefficients = {{0, 1.0}, {1, 1.0 + apart}};
      row.residual = -1.0 + noise(random);
      block.rows.push_back(row);
    }
  }
  return blocks;
}

TEST(RobotEvidence, RivalsPartWhereTheirRowsDifferNotWhereTheBlockBegins) {
  const RobotEvidence found = find_causes(blocks_that_begin_standing(), kKinds, two_payloads());
  ASSERT_EQ(found.findings.size(), 1U);
  const RobotFinding& payload = found.findings.front();
  ASSERT_EQ(payload.or_instead.size(), 1U) << "the two can't be told apart";
  EXPECT_GT(payload.apart[static_cast<std::size_t>(Support::kHanging)],
            10.0 * payload.apart[static_cast<std::size_t>(Support::kStanding)]);
}

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

// A joint that turns at a constant speed v is at q + share v T on average over the steps of a tick from q.
TEST(DriveSampling, SamplesAreMeansOverTheStepsOfTheDrivesThatRecorded) {
  constexpr double kSpeed_rad_s = 0.3, kTick_s = 0.01;
  for (const double step_s : {0.0, 0.002, 0.005}) {
    RobotRecording recording{.name = "ramp", .period_s = kTick_s, .drive = {step_s, "the test"}};
    for (int k = 0; k < 60; ++k) {
      RobotTick tick;
      tick.t_s = k * kTick_s;
      tick.state.q = JointVector::Constant(1, kSpeed_rad_s * tick.t_s);
      tick.state.dq = JointVector::Constant(1, kSpeed_rad_s);
      for (JointVector* v :
           {&tick.command.q, &tick.command.dq, &tick.command.kp, &tick.command.kd, &tick.command.tau_ff})
        v->setZero(1);
      recording.ticks.push_back(tick);
    }
    const std::vector<RobotSample> samples = robot_samples(recording);
    ASSERT_FALSE(samples.empty());
    const double share = step_s > 0.0 ? 0.5 * (1.0 - step_s / kTick_s) : 0.5;
    for (const RobotSample& sample : samples) {
      const double tick_begins_s = sample.t_s - 0.5 * kTick_s;  // a sample's time is its tick's middle
      EXPECT_NEAR(sample.q[0], kSpeed_rad_s * (tick_begins_s + share * kTick_s), 1e-9) << step_s;  // rounding
    }
  }
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
