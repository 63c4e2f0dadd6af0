// When the robot counts as hanging, and when as standing again.
#include "faults/foot_load_watch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "control/fixtures.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::faults {
namespace {

using test::kTick_s;

/// Largest delay that the filter of 0.02 s adds to a dwell, when the whole weight comes or goes at once.
constexpr int kFilterTicks = 5;

class FootLoadWatchTest : public testing::Test {
 protected:
  FootLoadWatchTest() {
    const Eigen::Index n = robot_.joint_index.size();
    command_.q = state_.q;
    command_.dq = command_.kp = command_.kd = command_.tau_ff = JointVector::Zero(n);
    command_.kp.setConstant(120.0);
  }

  /// Ticks until the watch reports this footing, or -1.
  int ticks_until(Footing footing, PerFoot<double> carried, int most = 100) {
    for (int tick = 1; tick <= most; ++tick) {
      step(carried);
      if (watch_.footing() == footing) return tick;
    }
    return -1;
  }
  void step(PerFoot<double> carried) {
    feet_.apply(carried, state_);
    watch_.update(state_, command_, walks_);
  }
  void stand() { ASSERT_NE(ticks_until(Footing::kStands, {0.5, 0.5}), -1); }
  /// Commands the drives to give the measured torques.
  void ask_for_torques() { command_.q = state_.q + state_.tau.cwiseQuotient(command_.kp); }

  const model::RobotModel& robot_ = test::z1();
  test::LoadedFeet feet_{robot_};
  model::RobotState state_ = test::standing_state(robot_);
  model::JointCommand command_;
  bool walks_ = false;
  FootLoadOptions options_;
  FootLoadWatch watch_{robot_, options_, kTick_s};
};

TEST_F(FootLoadWatchTest, OfARobotThatBeginsNothingIsKnownUntilItsFeetCarryItOrNothing) {
  EXPECT_EQ(watch_.footing(), Footing::kUnknown);
  const int lost = ticks_until(Footing::kHangs, {0.0, 0.0});
  EXPECT_GE(lost, 11);
  EXPECT_LE(lost, 11 + kFilterTicks);
  watch_.start();
  EXPECT_EQ(watch_.footing(), Footing::kUnknown);
  const int found = ticks_until(Footing::kStands, {0.5, 0.5});
  EXPECT_GE(found, 5);
  EXPECT_LE(found, 5 + kFilterTicks);
  EXPECT_NEAR(watch_.share()[kLeft] + watch_.share()[kRight], 1.0, 0.1);
}

TEST_F(FootLoadWatchTest, HangsWhenTheFeetHaveCarriedNothingForATenthOfASecond) {
  stand();
  const int lost = ticks_until(Footing::kHangs, {0.0, 0.0});
  EXPECT_GE(lost, 11);
  EXPECT_LE(lost, 11 + kFilterTicks);
}

TEST_F(FootLoadWatchTest, AShorterFlightIsAStep) {
  stand();
  for (int jump = 0; jump < 20; ++jump) {
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.0}, 10), -1);
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.6, 0.6}, 5), -1);
  }
}

TEST_F(FootLoadWatchTest, WhatFallsFreelyFliesAndDoesNotHang) {
  stand();
  state_.acceleration_m_s2.setZero();
  EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.0}), -1);
  state_.acceleration_m_s2 = {0.0, 0.0, 9.81};
  EXPECT_NE(ticks_until(Footing::kHangs, {0.0, 0.0}), -1);
}

TEST_F(FootLoadWatchTest, OneFootIsEnough) {
  stand();
  EXPECT_EQ(ticks_until(Footing::kHangs, {1.0, 0.0}), -1);
  EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 1.0}), -1);
  EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.35}), -1) << "most of it in a rope";
}

/// As legs in the air that are thrown about look.
TEST_F(FootLoadWatchTest, AWalkingRobotHangsWhenItsFeetCarryHalfOfItsWeightOnAverageAndAStandingOneDoesNot) {
  constexpr int kTicks = 60;
  for (const bool walks : {false, true}) {
    watch_.start();
    walks_ = false;
    stand();
    walks_ = walks;
    int seen = -1;
    for (int tick = 1; tick <= kTicks && seen < 0; ++tick) {
      step(tick % 10 < 7 ? PerFoot<double>{0.1, 0.1} : PerFoot<double>{0.4, 0.4});
      if (watch_.footing() == Footing::kHangs) seen = tick;
    }
    EXPECT_EQ(seen > 0, walks);
    EXPECT_LE(seen, 35);
  }
}

TEST_F(FootLoadWatchTest, AWalkingRobotWhoseFeetCarryLittleForSixHundredthsOfASecondAtATimeGoesOn) {
  stand();
  walks_ = true;
  for (int stride = 0; stride < 20; ++stride) {
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.0}, 6), -1);
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 1.1}, 40), -1);
  }
}

TEST_F(FootLoadWatchTest, AFlightOfAWalkingRobotIsNoHanging) {
  stand();
  walks_ = true;
  for (int flight = 0; flight < 5; ++flight) {
    state_.acceleration_m_s2.setZero();
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.0}, 30), -1);
    state_.acceleration_m_s2 = {0.0, 0.0, 9.81};
    EXPECT_EQ(ticks_until(Footing::kHangs, {0.6, 0.6}, 30), -1);
  }
}

TEST_F(FootLoadWatchTest, BetweenItsTwoThresholdsNothingChanges) {
  EXPECT_EQ(ticks_until(Footing::kStands, {0.15, 0.15}), -1);
  stand();
  EXPECT_EQ(ticks_until(Footing::kHangs, {0.15, 0.15}), -1);
}

TEST_F(FootLoadWatchTest, TorqueReadingsThatVanishChangeNothingWhileTheDrivesAreAskedToCarry) {
  stand();
  feet_.apply({0.5, 0.5}, state_);
  ask_for_torques();
  state_.tau.setZero();
  for (int tick = 0; tick < 100; ++tick) {
    watch_.update(state_, command_, walks_);
    ASSERT_EQ(watch_.footing(), Footing::kStands) << tick;
  }
}

TEST_F(FootLoadWatchTest, ABrokenStateAndAStraightKneeChangeNothing) {
  stand();
  feet_.apply({0.0, 0.0}, state_);
  for (const auto& spoil : {+[](model::RobotState& s) { s.tau[2] = std::numeric_limits<double>::quiet_NaN(); },
                            +[](model::RobotState& s) { s.q[2] = std::numeric_limits<double>::infinity(); },
                            +[](model::RobotState& s) { s.dq.conservativeResize(3); },
                            +[](model::RobotState& s) { s.gyro_rad_s.x() = std::numeric_limits<double>::quiet_NaN(); },
                            +[](model::RobotState& s) { s.orientation_WI.coeffs().setZero(); }}) {
    model::RobotState spoilt = state_;
    spoil(spoilt);
    for (int tick = 0; tick < 50; ++tick) watch_.update(spoilt, command_, walks_);
    EXPECT_EQ(watch_.footing(), Footing::kStands);
    EXPECT_TRUE(std::isfinite(watch_.share()[kLeft]));
  }
  state_.q[robot_.joint_index.at("left_knee")] = 0.0;
  EXPECT_EQ(ticks_until(Footing::kHangs, {0.0, 0.0}), -1) << "a straight leg may stand without torque";
}

// A knee of 6 degrees carries much with little torque. A leg that strikes the ground brakes within some hundredths of a
// second: torques that don't fit its acceleration look like a pull of more than the robot's weight.
TEST_F(FootLoadWatchTest, ANearlyStraightLegThatBrakesIsNoFootWithoutLoad) {
  const Eigen::Index knees[] = {robot_.joint_index.at("left_knee"), robot_.joint_index.at("right_knee")};
  for (const auto knee : knees) state_.q[knee] = 0.10;
  stand();
  constexpr int kTicks = 5;
  for (const double sign : {1.0, -1.0, 1.0, -1.0}) {
    for (int tick = 0; tick < 2 * kTicks; ++tick) {
      const double direction = tick < kTicks ? sign : -sign;  // it ends as slow as it began
      feet_.apply({0.5, 0.5}, state_);
      for (const auto knee : knees) {
        state_.dq[knee] += 0.5 * direction;
        state_.tau[knee] += 6.0 * direction;
      }
      watch_.update(state_, command_, walks_);
      ASSERT_EQ(watch_.footing(), Footing::kStands) << sign << ", " << tick;
    }
  }
  state_.dq.setZero();
  EXPECT_GE(ticks_until(Footing::kHangs, {0.0, 0.0}), 10) << "still legs tell it";
}

TEST_F(FootLoadWatchTest, ATiltedRobotIsWeighedAlongGravity) {
  stand();
  // The leg torques are those of an upright robot: the error of their own weight is below a tenth of the robot's.
  state_.orientation_WI = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitY()) * state_.orientation_WI;
  EXPECT_EQ(ticks_until(Footing::kHangs, {1.0, 0.0}), -1);
  EXPECT_NEAR(watch_.share()[kLeft], std::cos(0.9), 0.15);
}

TEST_F(FootLoadWatchTest, RefusesThresholdsThatCanNotBe) {
  for (const auto& spoil :
       {+[](FootLoadOptions& o) { o.lost_share = 0.4; }, +[](FootLoadOptions& o) { o.lost_s = 0.0; },
        +[](FootLoadOptions& o) { o.found_s = -1.0; }, +[](FootLoadOptions& o) { o.filter_s = std::nan(""); },
        +[](FootLoadOptions& o) { o.change_per_sqrt_s = 0.0; }, +[](FootLoadOptions& o) { o.blind_share = -1.0; },
        +[](FootLoadOptions& o) { o.lost_walking_share = 0.1; }, +[](FootLoadOptions& o) { o.walking_s = 0.0; },
        +[](FootLoadOptions& o) { o.wrong_inertia_share = std::nan(""); }}) {
    FootLoadOptions options;
    spoil(options);
    EXPECT_THROW(FootLoadWatch(robot_, options, kTick_s), std::invalid_argument);
  }
}

TEST_F(FootLoadWatchTest, NeverUsesTheHeap) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  const long before = test::allocation_count();
  for (int tick = 0; tick < 100; ++tick) watch_.update(state_, command_, walks_);
  EXPECT_EQ(test::allocation_count() - before, 0);
}

}  // namespace
}  // namespace pmg::faults
