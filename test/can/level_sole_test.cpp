// pmg_bus level: an ankle's motors are told by a sole that lies level.
#include "can/level_sole.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <string>

#include "can/hanging_stage.hpp"
#include "can/linked_drives.hpp"
#include "can/plumb.hpp"
#include "can/roll_call.hpp"
#include "refusal.hpp"

namespace pmg::can {
namespace {

using testing::HasSubstr;
using Tells = Verdict::Tells;
using test::Connected;
constexpr double kDeg = kRadPerDegree;
constexpr const char *kPitch = "left_ankle_pitch", *kRoll = "left_ankle_roll";

double& of(JointVector& q, const std::string& joint) { return q[test::z1().joint_index.at(joint)]; }

/// Stands; its left shank leans by these, and its ankle has the sole's normal along up_B.
JointVector on_level(double roll_rad, double pitch_rad, const Eigen::Vector3d& up_B) {
  JointVector q = test::z1().q_stand();
  of(q, "left_hip_roll") = roll_rad;
  of(q, "left_hip_pitch") = std::min(pitch_rad, 0.0) - 0.2;
  of(q, "left_knee") = std::max(pitch_rad, 0.0) + 0.2;
  const Eigen::Vector3d normal = link_in_base(test::z1(), "left_knee_link", q).conjugate() * up_B;
  of(q, kPitch) = std::atan2(normal.x(), normal.z());
  of(q, kRoll) = -std::asin(normal.y());
  return q;
}

/// What robot.yaml makes of an ankle whose motors are connected so. Nullopt: no angles belong to the cranks'.
std::optional<JointVector> read(const BusSetup& bus, const Connected& truth, JointVector q,
                                const test::CrankAngles& zeros_rad = test::CrankAngles::Zero()) {
  const auto& linkage = bus.parallel[0].linkage;
  const auto cranks = linkage.motor_angles({of(q, kPitch), of(q, kRoll)});
  if (!cranks) return std::nullopt;
  const auto joints = linkage.joint_angles(test::motors_of(truth, *cranks) + zeros_rad, test::CrankAngles::Zero());
  if (!joints) return std::nullopt;
  of(q, kPitch) = (*joints)[0];
  of(q, kRoll) = (*joints)[1];
  return q;
}

/// A floor, zeros and an IMU that are each some degrees off.
class Errors {
 public:
  explicit Errors(std::uint64_t seed) : random_(seed) {}
  double within(double least, double most) { return std::uniform_real_distribution(least, most)(random_); }
  Eigen::Vector3d about(const Eigen::Vector3d& direction, double most_rad) {
    const double turn_rad = within(-M_PI, M_PI), off_rad = within(0.0, most_rad);
    return Eigen::AngleAxisd(off_rad, Eigen::Vector3d(std::cos(turn_rad), std::sin(turn_rad), 0.0)) * direction;
  }
  test::CrankAngles zeros(double most_rad) { return {within(-most_rad, most_rad), within(-most_rad, most_rad)}; }

 private:
  std::mt19937_64 random_;
};

class LevelSole : public testing::Test {
 protected:
  Verdict verdict(const JointVector& q, const Eigen::Vector3d& down_B = -Eigen::Vector3d::UnitZ()) const {
    return verdict_of_level_sole(test::z1(), q, bus_, test::first_motor(bus_), down_B);
  }
  const DriveSetup setup_ = test::z1_with(kPitch, kRoll, -0.25);
  const BusSetup& bus_ = test::bus_of(setup_);
};

TEST_F(LevelSole, WithTheShankInclinedEveryWayToConnectAnAnklesMotorsIsNamed) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Errors errors(seed);
    for (const Connected& truth : test::all_ways_to_connect()) {
      const double side = errors.within(-1.0, 1.0) < 0.0 ? -1.0 : 1.0,
                   way = errors.within(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      const JointVector q = on_level(side * errors.within(9.0, 11.0) * kDeg, way * errors.within(23.0, 27.0) * kDeg,
                                     errors.about(Eigen::Vector3d::UnitZ(), 1.5 * kDeg));
      const auto seen = read(bus_, truth, q, errors.zeros(1.0 * kDeg));
      ASSERT_TRUE(seen);
      const Verdict said = verdict(*seen, errors.about(-Eigen::Vector3d::UnitZ(), 1.0 * kDeg));
      const std::string words = test::words_of(truth, kPitch, kRoll);
      EXPECT_EQ(said.text,
                words.empty() ? "motors, rods and directions agree with the model" : "the sole lies as if " + words)
          << "seed " << seed;
      EXPECT_EQ(said.tells, words.empty() ? Tells::kAgrees : Tells::kWrong);
    }
  }
}

TEST_F(LevelSole, InAnyPostureNothingFalseIsSaid) {
  int named = 0, left = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Errors errors(seed);
    for (const Connected& truth : test::all_ways_to_connect()) {
      const JointVector q = on_level(errors.within(-0.35, 0.35), errors.within(-0.7, 0.6),
                                     errors.about(Eigen::Vector3d::UnitZ(), 2.0 * kDeg));
      const auto seen = read(bus_, truth, q, errors.zeros(1.0 * kDeg));
      if (!seen) continue;  // scan says so
      const Verdict said = verdict(*seen, errors.about(-Eigen::Vector3d::UnitZ(), 1.0 * kDeg));
      const std::string words = test::words_of(truth, kPitch, kRoll);
      named += said.tells == Tells::kNotAll ? 0 : 1;
      left += said.tells == Tells::kNotAll ? 1 : 0;
      if (words.empty()) {
        EXPECT_NE(said.tells, Tells::kWrong) << "seed " << seed << ": " << said.text;
        continue;
      }
      EXPECT_NE(said.tells, Tells::kAgrees) << "seed " << seed << ": " << words;
      const std::string all =
          said.tells == Tells::kWrong ? said.text + ";" : fmt::format("{}:", fmt::join(said.look, ""));
      EXPECT_TRUE(all.find("if " + words + (said.tells == Tells::kWrong ? ";" : ":")) != std::string::npos)
          << "seed " << seed << ": " << words << " isn't in: " << all;
    }
  }
  RecordProperty("named", named);
  RecordProperty("left", left);
  EXPECT_GT(named, left / 2);
}

TEST_F(LevelSole, AStraightShankTellsNothingAndSaysHowToInclineIt) {
  const Verdict said = verdict(on_level(0.0, 0.0, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(said.tells, Tells::kNotAll);
  EXPECT_THAT(said.text, testing::AllOf(HasSubstr("the sole's angle can't tell it from 7 other arrangements"),
                                        HasSubstr("incline the shank")));
  EXPECT_EQ(said.look.size(), 8U);
  EXPECT_THAT(said.look.front(),
              testing::MatchesRegex("as robot.yaml has it: the sole is [0-9]\\.[0-9] deg off level"));
}

TEST_F(LevelSole, ASoleThatLiesNotLevelIsSaidAndAnArmHasNone) {
  const JointVector q = on_level(0.0, 0.0, Eigen::Vector3d::UnitZ());
  const Verdict said = verdict(q, Eigen::Vector3d(0.0, 0.5, -1.0).normalized());
  EXPECT_EQ(said.tells, Tells::kWrong);
  EXPECT_THAT(said.text, HasSubstr("no way to connect these motors puts the sole level, the best is 2"));
  const Verdict nearly = verdict(on_level(10.0 * kDeg, 25.0 * kDeg, Eigen::Vector3d::UnitZ()),
                                 Eigen::Vector3d(0.0, std::sin(7.0 * kDeg), -std::cos(7.0 * kDeg)));
  EXPECT_EQ(nearly.tells, Tells::kWrong);
  EXPECT_THAT(nearly.text, HasSubstr("the best is 7.0 deg off"));
  const auto arm = std::ranges::find_if(setup_.buses, [](const BusSetup& bus) {
    return std::ranges::find(bus.motors, "left_elbow", &drives::MotorSetup::joint) != bus.motors.end();
  });
  const auto elbow = std::ranges::find(arm->motors, "left_elbow", &drives::MotorSetup::joint);
  EXPECT_THAT(test::refusal_by<std::invalid_argument>(
                  [&] { verdict_of_level_sole(test::z1(), q, *arm, *elbow, -Eigen::Vector3d::UnitZ()); }),
              HasSubstr("left_elbow is above no sole; expected a joint of a leg"));
}

// An ankle whose joints have a motor each: each joint by itself, the other one as robot.yaml has it.
TEST_F(LevelSole, AMotorThatTurnsItsJointAloneIsNamedWhenItsDirectionIsWrong) {
  const DriveSetup alone = load_drives(test::z1());
  const auto said = [&](const std::string& joint, JointVector q) {
    const auto motor = std::ranges::find(alone.buses[0].motors, joint, &drives::MotorSetup::joint);
    return verdict_of_level_sole(test::z1(), q, alone.buses[0], *motor, -Eigen::Vector3d::UnitZ());
  };
  const JointVector q = on_level(10.0 * kDeg, 25.0 * kDeg, Eigen::Vector3d::UnitZ());
  for (const char* joint : {kPitch, kRoll}) {
    EXPECT_EQ(said(joint, q).tells, Tells::kAgrees) << joint;
    JointVector inverted = q;
    of(inverted, joint) = -of(inverted, joint);
    EXPECT_EQ(said(joint, inverted).text, fmt::format("the sole lies as if `direction` of {}'s motor is wrong", joint));
  }
}

/// Z1 in its gantry, behind emulated drives; somebody holds its leg so that the sole is level.
class HeldLeg : public testing::TestWithParam<Connected>, protected test::HangingStage {
 protected:
  HeldLeg() : HangingStage(connected(GetParam())), described_(test::z1_with(kPitch, kRoll, -0.25)) {}
  static DriveSetup connected(const Connected& truth) {
    DriveSetup setup = test::z1_with(kPitch, kRoll, -0.25);
    const auto bus = std::ranges::find_if(setup.buses, [](const BusSetup& one) { return !one.parallel.empty(); });
    test::connect_otherwise(*bus, test::z1(), truth);
    return setup;
  }
  DriveSetup described_;
};

TEST_P(HeldLeg, WhatTheDrivesSayTellsHowTheAnklesMotorsAreConnected) {
  const BusSetup& bus = test::bus_of(described_);
  const auto at = static_cast<std::size_t>(&bus - described_.buses.data());
  const auto with_imu =
      static_cast<std::size_t>(std::ranges::find(setup_.buses, true, &BusSetup::imu) - setup_.buses.begin());
  Plumb plumb(test::z1(), host_[with_imu].get());
  JointVector held;
  hands = [&](model::JointCommand& acting) {
    for (const char* joint : {"left_hip_pitch", "left_hip_roll", "left_hip_yaw", "left_knee", kPitch, kRoll}) {
      const auto j = test::z1().joint_index.at(joint);
      acting.q[j] = held[j];
      acting.dq[j] = acting.tau_ff[j] = 0.0;
      acting.kp[j] = 200.0;
      acting.kd[j] = 5.0;
    }
  };
  std::optional<Plumb::Sample> sample;
  for (int k = 0; k < 1000; ++k) {  // the hands follow the base as it leans
    if (sample = plumb.sample(sensed_.q); k == 0 || (k % 100 == 0 && sample))
      held = on_level(15.0 * kDeg, 25.0 * kDeg, sample ? Eigen::Vector3d(-sample->down_B) : Eigen::Vector3d::UnitZ());
    tick();
  }
  ASSERT_TRUE(sample);
  const auto answers = ask_bus(bus, *host_[at], [this] { tick(); }, {});
  const drives::Readings joints = drives::joint_readings(bus, motor_readings(bus, answers));
  JointVector q = sensed_.q;
  for (std::size_t m = 0; m < joints.size(); ++m) {
    ASSERT_TRUE(joints[m]) << bus.motors[m].joint;
    q[bus.motors[m].index] = joints[m]->q_rad;
  }
  const Verdict said = verdict_of_level_sole(test::z1(), q, bus, test::first_motor(bus), sample->down_B);
  const std::string words = test::words_of(GetParam(), kPitch, kRoll);
  EXPECT_EQ(said.text,
            words.empty() ? "motors, rods and directions agree with the model" : "the sole lies as if " + words);
  for (const std::string& line : said.look) fmt::print("{}\n", line);
}

const std::vector<Connected> kWays = test::all_ways_to_connect();
INSTANTIATE_TEST_SUITE_P(AsDescribed, HeldLeg, testing::Values(kWays.front()));
INSTANTIATE_TEST_SUITE_P(Swapped, HeldLeg, testing::Values(Connected{.swapped = true}));
INSTANTIATE_TEST_SUITE_P(EveryWay, HeldLeg, testing::ValuesIn(kWays));

}  // namespace
}  // namespace pmg::can
