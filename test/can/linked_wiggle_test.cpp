// pmg_bus wiggle on motors that turn their joints together: which motor turns which crank, and which way.
#include "can/linked_wiggle.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "can/hanging_stage.hpp"
#include "can/linked_drives.hpp"
#include "can/roll_call.hpp"
#include "refusal.hpp"

namespace pmg::can {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Tells = Verdict::Tells;
using test::all_ways_to_connect;
using test::bus_of;
using test::Connected;
using test::first_motor;
using test::words_of;

/// What a robot without friction shows whose motors are connected so, computed from its model. base: it has an IMU.
std::vector<LinkedWay> shown(const can::BusSetup& bus, const Connected& truth, const model::Hanging& hanging,
                             bool base) {
  using Angles = drives::RodLinkage<2>::Angles;
  const drives::LinkedMotors<2>& linked = bus.parallel[0];
  const auto motor = [&](std::size_t i) -> const drives::MotorSetup& { return bus.motors[linked.motors[i]]; };
  const auto end = [&](const Angles& asked) {
    const Angles motors = *linked.linkage.motor_angles(asked), cranks = test::cranks_of(truth, motors);
    const Angles q = *linked.linkage.joint_angles(cranks, Angles::Zero());
    JointVector whole = test::z1().q_stand();
    for (std::size_t i = 0; i < 2; ++i) whole[motor(i).index] = q[static_cast<Eigen::Index>(i)];
    CrankEnd shown{.crank_rad = {motors.begin(), motors.end()}};
    model::Hanging now = hanging;
    if (base) {
      const Eigen::Quaterniond base_WB = link_in_base(test::z1(), hanging.held_link, whole).conjugate();
      now.down_B = base_WB.conjugate() * hanging.down_B;  // in the held link's axes
      shown.plumb = Plumb::Sample{.down_B = now.down_B, .base_WB = base_WB};
    }
    Angles joints;
    for (std::size_t i = 0; i < 2; ++i)
      joints[static_cast<Eigen::Index>(i)] =
          model::gravity_load(test::z1(), motor(i).joint, whole, now).holding_Nm(q[static_cast<Eigen::Index>(i)]);
    const Angles held = test::motors_of(truth, linked.linkage.jacobian(cranks, q).transpose().inverse() * joints);
    shown.torque_Nm = {held.begin(), held.end()};
    return shown;
  };
  std::vector<LinkedWay> ways;
  for (Eigen::Index j = 0; j < 2; ++j) {
    Angles up = Angles::Zero(), low = Angles::Zero();
    up[j] = 0.15;
    low[j] = -0.15;
    ways.push_back({.joint = motor(static_cast<std::size_t>(j)).joint,
                    .asked_rad = 0.15,
                    .moved_rad = 0.15,
                    .asked_down_rad = 0.15,
                    .moved_down_rad = 0.15,
                    .begin = end(Angles::Zero()),
                    .highest = end(up),
                    .lowest = end(low),
                    .back = end(Angles::Zero())});
  }
  return ways;
}

TEST(LinkedVerdict, EveryWayToConnectAWaistsMotorsIsNamed) {
  const can::DriveSetup setup = test::z1_with("waist_roll", "waist_pitch", 0.12);
  const can::BusSetup& bus = bus_of(setup);
  const model::Hanging hanging{.held_link = test::z1().torso_link};
  for (const Connected& truth : all_ways_to_connect()) {
    const std::string words = words_of(truth, "waist_roll", "waist_pitch");
    const Verdict verdict = can::verdict(test::z1(), test::z1().q_stand(), bus, first_motor(bus),
                                         shown(bus, truth, hanging, true), hanging);
    EXPECT_EQ(verdict.tells, words.empty() ? Tells::kAgrees : Tells::kWrong) << words << ": " << verdict.text;
    EXPECT_EQ(verdict.text,
              words.empty() ? "motors, rods and directions agree with the model" : "it moves as if " + words);
  }
}

// Without an IMU, a robot that hangs obliquely: what the load can't tell is left to the eye, and nothing false is said.
TEST(LinkedVerdict, OfAWaistWithoutAnImuNothingFalseIsSaid) {
  const can::DriveSetup setup = test::z1_with("waist_roll", "waist_pitch", 0.12);
  const can::BusSetup& bus = bus_of(setup);
  const model::Hanging hanging{.down_B = Eigen::Vector3d(0.2, 0.15, -1.0).normalized(),
                               .held_link = test::z1().torso_link};
  for (const Connected& truth : all_ways_to_connect()) {
    const std::string words = words_of(truth, "waist_roll", "waist_pitch");
    const Verdict verdict = can::verdict(test::z1(), test::z1().q_stand(), bus, first_motor(bus),
                                         shown(bus, truth, hanging, false), hanging);
    if (words.empty()) {
      EXPECT_NE(verdict.tells, Tells::kWrong) << verdict.text;
    } else {
      EXPECT_NE(verdict.tells, Tells::kAgrees) << words;
      EXPECT_THAT(verdict.look, testing::Contains(testing::StartsWith("if " + words + ": ")));
    }
  }
}

// A base that still moves, or a payload, puts a load off by more than one friction: by up to 1.4 where nothing touched
// the limb. What fits it better by chance is then not taken for the truth.
TEST(LinkedVerdict, ALoadThatIsOffByLessThanTwoFrictionsRulesNothingOut) {
  const can::DriveSetup setup = test::z1_with("waist_roll", "waist_pitch", 0.12);
  const can::BusSetup& bus = bus_of(setup);
  const model::RobotModel& z1 = test::z1();
  const double friction_Nm = z1.joints[static_cast<std::size_t>(z1.joint_index.at("waist_roll"))].friction_Nm;
  for (const double lean : {0.005, 0.01, 0.015, 0.02, 0.03, 0.04}) {
    const model::Hanging hanging{.down_B = Eigen::Vector3d(lean, 0.75 * lean, -1.0).normalized(),
                                 .held_link = z1.torso_link};
    for (const std::array<double, 2>& off : {std::array{1.0, 1.0}, {1.0, -1.0}, {-1.0, 1.0}, {-1.0, -1.0}}) {
      std::vector<LinkedWay> ways = shown(bus, {}, hanging, false);
      for (LinkedWay& way : ways) {
        for (CrankEnd* end : {&way.highest, &way.lowest})
          for (std::size_t i = 0; i < 2; ++i)
            end->torque_Nm[i] += 2.4 * off[i] * friction_Nm;  // 1.4 frictions of a crank
      }
      const Verdict verdict = can::verdict(z1, z1.q_stand(), bus, first_motor(bus), ways, hanging);
      EXPECT_NE(verdict.tells, Tells::kWrong) << verdict.text;
      EXPECT_TRUE(verdict.tells == Tells::kAgrees ||
                  std::ranges::any_of(verdict.look,
                                      [](const std::string& one) { return one.starts_with("as robot.yaml has it"); }))
          << "lean " << lean << ", off " << off[0] << " " << off[1] << ": " << verdict.text;
    }
  }
}

// A foot weighs less than its joints' friction: the eye gets what each arrangement would look like.
TEST(LinkedVerdict, OfAnAnkleTheEyeIsToldWhatSwappedAndInvertedMotorsWouldLookLike) {
  const can::DriveSetup setup = test::z1_with("left_ankle_pitch", "left_ankle_roll", -0.25);
  const can::BusSetup& bus = bus_of(setup);
  const Verdict verdict =
      can::verdict(test::z1(), test::z1().q_stand(), bus, first_motor(bus), shown(bus, {}, {}, false));
  EXPECT_EQ(verdict.tells, Tells::kNotAll) << verdict.text;
  ASSERT_THAT(verdict.look, SizeIs(8));
  EXPECT_THAT(verdict.look.front(),
              testing::StartsWith("as robot.yaml has it: for left_ankle_pitch's + the limb goes "));
  std::set<std::string> seen;
  for (const std::string& line : verdict.look) seen.insert(line.substr(line.find(": ")));
  EXPECT_THAT(seen, SizeIs(8)) << "no two of them look alike";
  EXPECT_THAT(
      verdict.look,
      testing::Contains(testing::StartsWith("if the motors of left_ankle_pitch and left_ankle_roll are swapped: ")));
}

TEST(LinkedVerdict, AGearThatIsWrongIsNoArrangementAndAShortWayIsSaid) {
  const can::DriveSetup setup = test::z1_with("waist_roll", "waist_pitch", 0.12);
  const can::BusSetup& bus = bus_of(setup);
  const model::Hanging hanging{.down_B = Eigen::Vector3d(0.2, 0.15, -1.0).normalized(),
                               .held_link = test::z1().torso_link};
  std::vector<LinkedWay> ways = shown(bus, {}, hanging, false);
  for (LinkedWay& way : ways) {
    for (CrankEnd* end : {&way.highest, &way.lowest}) {
      for (double& torque_Nm : end->torque_Nm) torque_Nm *= 4.0;
    }
  }
  const auto said = [&] {
    return can::verdict(test::z1(), test::z1().q_stand(), bus, first_motor(bus), ways, hanging);
  };
  EXPECT_EQ(said().tells, Tells::kWrong);
  EXPECT_THAT(said().text, HasSubstr("no arrangement of these motors explains what they held: look at `gear`"));
  ways[1].moved_rad = 0.05;
  EXPECT_THAT(said().text, HasSubstr("waist_pitch moved less than half the way"));
}

TEST(LinkedRollCall, CranksThatNoPostureHasAndPosturesBeyondARangeAreNamed) {
  const can::DriveSetup setup = test::z1_with("left_ankle_pitch", "left_ankle_roll", -0.25);
  const can::BusSetup& bus = bus_of(setup);
  const drives::LinkedMotors<2>& ankle = bus.parallel[0];
  const auto said = [&](double first_rad, double second_rad) {
    std::vector<Answer> answers;
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      const drives::MotorLimits& limits = bus.motors[m].limits;
      double q_rad = 0.5 * (limits.q_lower_rad + limits.q_upper_rad);
      if (m == ankle.motors[0]) q_rad = first_rad;
      if (m == ankle.motors[1]) q_rad = second_rad;
      answers.push_back({.node = bus.motors[m].node, .count = 1, .reading = {.q_rad = q_rad}});
    }
    return problems(bus, answers);
  };
  const auto cranks = *ankle.linkage.motor_angles({-0.7, 0.2});  // toes up, which its range has; not toes down
  EXPECT_THAT(said(cranks[0], cranks[1]), IsEmpty());
  const auto toes_down = *ankle.linkage.motor_angles({0.95, 0.0});
  EXPECT_THAT(said(toes_down[0], toes_down[1]), IsEmpty()) << "0.2 rad more than its range: a limp joint on its stop";
  EXPECT_THAT(said(1.4, 1.4), testing::Contains(HasSubstr("left_ankle_pitch and left_ankle_roll (can0): ")));
  EXPECT_THAT(said(0.9, -1.0),
              testing::Contains(testing::AllOf(HasSubstr("left_ankle_pitch and left_ankle_roll (can0): "),
                                               HasSubstr("expected angles within their ranges"))));
}

/// Z1 in its gantry whose waist has a linkage, connected so.
class LinkedLight : public testing::TestWithParam<Connected>, protected test::HangingStage {
 protected:
  LinkedLight() : HangingStage(connected(GetParam())), described_(test::z1_with("waist_roll", "waist_pitch", 0.12)) {}
  static can::DriveSetup connected(const Connected& truth) {
    can::DriveSetup setup = test::z1_with("waist_roll", "waist_pitch", 0.12);
    const auto bus = std::ranges::find_if(setup.buses, [](const can::BusSetup& one) { return !one.parallel.empty(); });
    test::connect_otherwise(*bus, test::z1(), truth);
    return setup;
  }
  Verdict wiggled() {
    const can::BusSetup& bus = bus_of(described_);
    const auto at = static_cast<std::size_t>(&bus - described_.buses.data());
    const auto with_imu =
        static_cast<std::size_t>(std::ranges::find(setup_.buses, true, &can::BusSetup::imu) - setup_.buses.begin());
    Plumb plumb(test::z1(), bus.imu ? nullptr : host_[with_imu].get());
    const model::Hanging hanging{.held_link = test::z1().torso_link};
    const auto ways = wiggle_linked(
        test::z1(), sensed_.q, bus, first_motor(bus), *host_[at], {.by_rad = 0.12, .gain_share = 1.0},
        [this] { tick(); }, {}, hanging, &plumb);
    tick();  // the last frame arrives
    for (const std::size_t m : bus.parallel[0].motors) EXPECT_FALSE(drives_->drive(at, m).enabled());
    for (const LinkedWay& way : ways) EXPECT_NEAR(way.moved_rad, way.asked_rad, 0.3 * way.asked_rad) << way.joint;
    return can::verdict(test::z1(), sensed_.q, bus, first_motor(bus), ways, hanging);
  }
  can::DriveSetup described_;
};

TEST_P(LinkedLight, TheWaistsMotorsMoveTogetherAndHowTheyAreConnectedIsNamed) {
  const Verdict verdict = wiggled();
  const std::string words = words_of(GetParam(), "waist_roll", "waist_pitch");
  EXPECT_EQ(verdict.text,
            words.empty() ? "motors, rods and directions agree with the model" : "it moves as if " + words);
  for (const std::string& line : verdict.look) fmt::print("{}\n", line);
}

/// Z1 in its gantry, each motor of its left ankle beside the other in the shank.
class LinkedAnkle : public testing::Test, protected test::HangingStage {
 protected:
  LinkedAnkle() : HangingStage(test::z1_with("left_ankle_pitch", "left_ankle_roll", -0.25)) {}
  std::vector<LinkedWay> wiggled(const WiggleOptions& options) {
    return wiggle_linked(test::z1(), sensed_.q, setup_.buses[0], first_motor(setup_.buses[0]), *host_[0], options,
                         [this] { tick(); }, {});
  }
  std::string refusal(const WiggleOptions& options) {
    return test::refusal_by<std::runtime_error>([&] { wiggled(options); });
  }
};

TEST_F(LinkedAnkle, BothJointsMoveThroughTheRodsAndTheEyeIsAsked) {
  const std::vector<LinkedWay> ways = wiggled({.by_rad = 0.1, .gain_share = 1.0});
  ASSERT_THAT(ways, SizeIs(2));
  for (const LinkedWay& way : ways) {
    EXPECT_NEAR(way.moved_rad, way.asked_rad, 0.3 * way.asked_rad) << way.joint;
    EXPECT_NEAR(way.moved_down_rad, way.asked_down_rad, 0.3 * way.asked_down_rad) << way.joint;
  }
  const Verdict verdict = can::verdict(test::z1(), sensed_.q, setup_.buses[0], first_motor(setup_.buses[0]), ways);
  EXPECT_EQ(verdict.tells, Tells::kNotAll) << verdict.text;
  EXPECT_THAT(
      verdict.look,
      testing::Contains(testing::StartsWith("if the motors of left_ankle_pitch and left_ankle_roll are swapped: ")));
}

TEST_F(LinkedAnkle, WhatBlocksItAndAStartBeyondARangeSwitchBothMotorsOff) {
  EXPECT_THAT(refusal({.by_rad = 0.1, .gain_share = 1.0, .effort_share = -0.1}),
              HasSubstr("Nm at its crank; expected"));
  tick();
  for (const std::size_t m : {4U, 5U}) EXPECT_FALSE(drives_->drive(0, m).enabled());
  drives_->drive(0, 4).turn_rad = 1.2;
  EXPECT_THAT(refusal({}), testing::AnyOf(HasSubstr("expected a start within their ranges"),
                                          HasSubstr("no angles of these joints belong to their cranks'")));
  drives_->drive(0, 4).turn_rad = 0.0;
  drives_->drive(0, 5).silent = true;
  EXPECT_THAT(refusal({}), HasSubstr("left_ankle_roll (can0, node 6) does not answer"));
}

INSTANTIATE_TEST_SUITE_P(AsDescribed, LinkedLight, testing::Values(Connected{}));
INSTANTIATE_TEST_SUITE_P(Swapped, LinkedLight, testing::Values(Connected{.swapped = true}));
INSTANTIATE_TEST_SUITE_P(EveryOther, LinkedLight,
                         testing::Values(Connected{.inverted = {true, false}}, Connected{.inverted = {false, true}},
                                         Connected{.inverted = {true, true}},
                                         Connected{.swapped = true, .inverted = {true, false}},
                                         Connected{.swapped = true, .inverted = {false, true}},
                                         Connected{.swapped = true, .inverted = {true, true}}));

}  // namespace
}  // namespace pmg::can
