#include "drives/motor_monitor.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pmg::drives {
namespace {

constexpr MotorLimits kMotorLimits = {.q_lower_rad = -2.0, .q_upper_rad = 2.0, .dq_rad_s = 10.0, .torque_Nm = 50.0};

void ask(MotorMonitor& monitor, bool enabling) {
  monitor.begin();
  if (!monitor.pauses()) monitor.ask(enabling);
}

TEST(MotorMonitor, AMotorAtFullSpeedIsBelieved) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 100; ++k) {
    ask(monitor, k == 0);
    ASSERT_TRUE(monitor.hear({.q_rad = 15.0 * 0.002 * k, .dq_rad_s = 15.0}))
        << "1.5 times the limit is the control thread's fault";
  }
  EXPECT_EQ(monitor.condition(true), Condition::kGood);
}

TEST(MotorMonitor, ADamagedReadingIsDroppedAndThreeAreALostPosition) {
  MotorMonitor monitor(kMotorLimits);
  ask(monitor, true);
  monitor.hear({.q_rad = 0.1});
  for (const double bad : {1.0, std::numeric_limits<double>::quiet_NaN()}) {
    ask(monitor, false);
    EXPECT_FALSE(monitor.hear({.q_rad = bad}));
  }
  ask(monitor, false);
  EXPECT_TRUE(monitor.hear({.q_rad = 0.1}));
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
  for (int k = 0; k < 3; ++k) {
    ask(monitor, false);
    EXPECT_FALSE(monitor.hear({.q_rad = -1.5}));
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kPositionJump);
  EXPECT_EQ(monitor.reading().q_rad, 0.1);
}

/// The least jump of a reading that isn't believed, from and to these speeds, in steps of 1 mrad.
double least_jump_rad(double before_rad_s, double after_rad_s, double sign) {
  for (double jump_rad = 0.0; jump_rad < 1.0; jump_rad += 0.001) {
    MotorMonitor monitor({.q_lower_rad = -2.0, .q_upper_rad = 2.0, .dq_rad_s = 18.0, .torque_Nm = 50.0});
    ask(monitor, true);
    monitor.hear({.dq_rad_s = before_rad_s});
    ask(monitor, false);
    if (!monitor.hear({.q_rad = sign * jump_rad, .dq_rad_s = after_rad_s})) return jump_rad;
  }
  return 1.0;
}

// The numbers of docs/reference/safety.md.
TEST(MotorMonitor, ALostTurnIsSeenFromTheDocumentedSizeOn) {
  constexpr double kStep_rad = 0.001;
  EXPECT_NEAR(least_jump_rad(0.0, 0.0, 1.0), 0.062, kStep_rad) << "a motor at rest";
  EXPECT_NEAR(least_jump_rad(6.0, 6.0, -1.0), 0.062, kStep_rad) << "against its motion";
  EXPECT_NEAR(least_jump_rad(6.0, 6.0, 1.0), 0.098, kStep_rad) << "with its motion";
  EXPECT_NEAR(least_jump_rad(0.0, 6.0, 1.0), 0.098, kStep_rad) << "the faster of both speeds counts";
  EXPECT_NEAR(least_jump_rad(18.0, 18.0, 1.0), 0.170, kStep_rad);
  EXPECT_NEAR(least_jump_rad(30.0, 30.0, 1.0), 0.194, kStep_rad) << "however fast it says that it is";
}

TEST(MotorMonitor, AMotorThatHitsItsStopHardIsBelieved) {
  MotorMonitor monitor(kMotorLimits);
  double q_rad = 0.0, dq_rad_s = 10.0;
  for (int k = 0; k < 200; ++k) {
    ask(monitor, k == 0);
    ASSERT_TRUE(monitor.hear({.q_rad = q_rad, .dq_rad_s = dq_rad_s})) << k;
    if (q_rad > 0.5) dq_rad_s = -10.0;  // within one cycle
    if (q_rad < 0.1) dq_rad_s = 10.0;
    q_rad += dq_rad_s * MotorMonitor::kPeriod_s;
  }
}

TEST(MotorMonitor, ADamagedReadingIsNoAnswer) {
  MotorMonitor monitor(kMotorLimits);
  ask(monitor, true);
  monitor.hear({.q_rad = 0.1});
  for (int k = 0; k < 2; ++k) {
    ask(monitor, false);
    monitor.hear({.q_rad = 1.5});
  }
  EXPECT_EQ(monitor.age_cycles(), 2);
  EXPECT_EQ(monitor.condition(true), Condition::kLate);
}

TEST(MotorMonitor, TravelOfAFrozenEncoderCountsTheCyclesWithoutAnAnswerToo) {
  MotorMonitor monitor(kMotorLimits);
  int cycles = 0;
  while (monitor.trouble(false) != Trouble::kFrozenEncoder && cycles < 100) {  // an answer in every second cycle
    ask(monitor, cycles == 0);
    if (cycles++ % 2 == 0) monitor.hear({.q_rad = 0.3, .dq_rad_s = 6.0});
  }
  EXPECT_EQ(cycles, 11) << "0.024 rad from answer to answer: the fifth after the first is beyond 0.1 rad";
}

TEST(MotorMonitor, DamagedReadingsBetweenGoodOnesAreNoLostPosition) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 20; ++k) {
    ask(monitor, k == 0);
    EXPECT_EQ(monitor.hear({.q_rad = k % 2 == 0 ? 0.1 : 1.5}), k % 2 == 0) << k;
  }
  EXPECT_EQ(monitor.refused(), 10u);
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, BunchedAnswersAreNoSecondDriveAndASecondDriveIsFoundAllTheSame) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 6; ++k) ask(monitor, false);
  for (int k = 0; k < 6; ++k) monitor.hear({});
  EXPECT_EQ(monitor.uncalled(), 0u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(monitor.trouble(false), Trouble::kNone);
    ask(monitor, false);
    monitor.hear({});
    monitor.hear({});
  }
  EXPECT_EQ(monitor.trouble(false), Trouble::kTwoOfOneNode);
}

TEST(MotorMonitor, WhatTwoDrivesOfOneNodeSaidIsNotHeldAgainstTheOneThatStays) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 5; ++k) {
    ask(monitor, false);
    monitor.hear({.q_rad = 0.1});
  }
  for (int k = 0; k < 5; ++k) {
    ask(monitor, false);
    monitor.hear({.q_rad = 1.0});  // the other one, and first
    monitor.hear({.q_rad = 0.1});
  }
  EXPECT_EQ(monitor.trouble(false), Trouble::kTwoOfOneNode) << "and no lost turn";
  for (int k = 0; k <= MotorMonitor::kUncalledCycles; ++k) {
    ask(monitor, false);
    monitor.hear({.q_rad = 0.1});
  }
  EXPECT_EQ(monitor.trouble(false), Trouble::kNone);
  EXPECT_EQ(monitor.reading().q_rad, 0.1);
}

TEST(MotorMonitor, AMotorAtRestWithAnOffsetOfItsSpeedHasNoFrozenEncoder) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 10'000; ++k) {
    ask(monitor, k == 0);
    monitor.hear({.q_rad = 0.3, .dq_rad_s = MotorMonitor::kSpeedOffset_rad_s});
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, AMotorThatTurnsBackAndForthAFewStepsHasNoFrozenEncoder) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 1000; ++k) {  // it stands still for three cycles at a time: 0.018 rad at 3 rad/s
    ask(monitor, k == 0);
    monitor.hear({.q_rad = k / 4 % 2 == 0 ? 0.3 : 0.31, .dq_rad_s = 3.0});
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, ADriveIsEnabledOnlyByAnAnswerToItsRequest) {
  MotorMonitor monitor(kMotorLimits);
  ask(monitor, true);
  EXPECT_FALSE(monitor.enabled());
  monitor.hear({});
  EXPECT_TRUE(monitor.enabled());
  monitor.interrupt();
  ask(monitor, false);
  monitor.hear({});
  EXPECT_FALSE(monitor.enabled());
  EXPECT_EQ(monitor.trouble(true), Trouble::kNotEnabled);
  EXPECT_EQ(monitor.trouble(false), Trouble::kNone) << "limp anyway";
}

TEST(MotorMonitor, AnAnswerToAnEarlierRequestEnablesNothing) {
  MotorMonitor monitor(kMotorLimits);
  ask(monitor, false);
  ask(monitor, true);
  monitor.hear({});
  EXPECT_FALSE(monitor.enabled()) << "it belongs to the request before";
  monitor.hear({});
  EXPECT_TRUE(monitor.enabled());
}

}  // namespace
}  // namespace pmg::drives
