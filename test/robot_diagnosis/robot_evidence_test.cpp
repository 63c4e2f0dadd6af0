// Causes from equations that are written down by hand.
#include "robot_diagnosis/robot_evidence.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>

#include "evidence/thresholds.hpp"
#include "robot_diagnosis/drive_sampling.hpp"
#include "robot_diagnosis/robot_samples.hpp"
#include "sim/robots.hpp"

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

TEST(RobotDiagnosisOptions, EachHasAReasonAndTheDataThatItWasSetOn) {
  std::set<std::string> names;
  for (const nlohmann::ordered_json& row : evidence::thresholds_json(RobotDiagnosisOptions{})) {
    EXPECT_TRUE(names.insert(row["name"]).second) << row["name"];
    EXPECT_FALSE(row["reason"].get<std::string>().empty()) << row["name"];
    EXPECT_FALSE(row["set_on"].get<std::string>().empty()) << row["name"];
  }
  EXPECT_TRUE(names.contains("causes.delay_s.relevant"));
}

// Means over the beginnings, and over the ends, of the steps of a tick.
TEST(DriveSampling, MeansAreThoseOfTheStepsOfATick) {
  constexpr double kTick_s = 0.01;
  for (const int n : {5, 20, 1000}) {
    const DriveSampling sampling{.step_s = kTick_s / n};
    for (const double from : {0.0, 0.2, 0.4}) {
      PathWeights sum = PathWeights::Zero();
      int steps = 0;
      for (int k = static_cast<int>(std::lround(from * n)); k < n; ++k, ++steps)
        sum += path_position(static_cast<double>(k) / n);
      EXPECT_NEAR((sampling.mean_position(from, 1.0, kTick_s) - sum / steps).norm(), 0.0, 1e-12) << n << " " << from;
    }
    double ends = 0.0;
    for (int k = 1; k <= n; ++k) ends += static_cast<double>(k) / n / n;
    EXPECT_NEAR(sampling.acceleration_share(kTick_s), ends, 1e-12);
  }
}

/// A joint on the path 1 - s/2 + s^2/4 - 2 s^3, which both ticks' cubics hit.
double on_path(double s) { return 1.0 - s / 2.0 + s * s / 4.0 - 2.0 * s * s * s; }
PathWeights path_of_it() {
  const auto speed = [](double s) { return -0.5 + s / 2.0 - 6.0 * s * s; };
  PathWeights path;
  path << on_path(-1.0), on_path(0.0), on_path(1.0), speed(-1.0), speed(0.0), speed(1.0);
  return path;
}
double mean_on_path(double from, double to) {
  const auto integral = [](double s) { return s - s * s / 4.0 + s * s * s / 12.0 - s * s * s * s / 2.0; };
  return (integral(to) - integral(from)) / (to - from);
}

TEST(DriveSampling, PositionsWithinATickAreTheCubicThroughBothEnds) {
  const PathWeights path = path_of_it();
  for (const double s : {-1.0, -0.4, 0.0, 0.3, 1.0}) EXPECT_NEAR(path_position(s).dot(path), on_path(s), 1e-12) << s;
  for (const double s : {-0.4, 0.3}) EXPECT_NEAR(path_integral(s).dot(path), s * mean_on_path(0.0, s), 1e-12) << s;
  EXPECT_NEAR(DriveSampling{}.mean_position(0.0, 1.0, 0.01).dot(path), mean_on_path(0.0, 1.0), 1e-12)
      << "a drive much faster than the tick";
}

TEST(DriveSampling, EachCommandIsInForceFromItsArrivalToThatOfTheNext) {
  const PathWeights path = path_of_it();
  const auto expect = [&](const CommandInForce& part, double share, double from, double to) {
    EXPECT_NEAR(part.share, share, 1e-12);
    EXPECT_NEAR(part.position.dot(path), mean_on_path(from, to), 1e-12);
    EXPECT_NEAR(part.speed.dot(path), (on_path(to) - on_path(from)) / (to - from), 1e-12);
  };
  const DriveSampling bus{.command_delay_s = 0.002,
                          .older_joints = {1},
                          .older_by_s = 0.001,
                          .closed_by_bus = {2},
                          .bus_loop_age_s = 0.003};
  expect(bus.in_force(0, 0.01)[0], 0.2, 0.0, 0.2);
  expect(bus.in_force(0, 0.01)[1], 0.8, 0.2, 1.0);
  expect(bus.in_force(1, 0.01)[0], 0.3, 0.0, 0.3);
  expect(bus.in_force(1, 0.01)[1], 0.7, 0.3, 1.0);
  expect(bus.in_force(2, 0.01)[0], 0.2, -0.3, -0.1);
  expect(bus.in_force(2, 0.01)[1], 0.8, -0.1, 0.7);
  EXPECT_EQ(DriveSampling{}.in_force(0, 0.01)[0].share, 0.0) << "no bus";
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
  EXPECT_EQ(drive_sampling("ethercat", R"({"drive_sampling_s": 0.001})", z1().joint_index).step_s, 0.001);
  EXPECT_EQ(drive_sampling("sil", "{}", z1().joint_index).step_s, 0.002);
  const DriveSampling unknown = drive_sampling("can", "", z1().joint_index);
  EXPECT_EQ(unknown.step_s, 0.0);
  EXPECT_NE(drive_sampling_text(unknown).find("'can' doesn't say"), std::string::npos);
  EXPECT_NE(drive_sampling_text(unknown).find("none is assumed"), std::string::npos);
  EXPECT_EQ(drive_sampling("can", R"({"command_delay_s": 0.002})", z1().joint_index).command_delay_s, 0.002);
}

TEST(DriveSampling, WhatCantBeIsRefusedWithItsKey) {
  for (const auto& [options, key] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"({"command_delay_s": -0.001})", "command_delay_s"},
           {R"({"drive_sampling_s": 0.02})", "drive_sampling_s"},
           {R"({"older_by_s": "2 ms"})", "older_by_s"},
           {R"({"closed_by_bus": ["no_such_joint"]})", "no_such_joint"},
           {R"({"older_joints": [3]})", "older_joints"}}) {
    try {
      drive_sampling("can", options, z1().joint_index);
      ADD_FAILURE() << options;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace pmg::robot_diagnosis
