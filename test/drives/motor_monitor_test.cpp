#include "drives/motor_monitor.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pmg::drives {
namespace {

constexpr MotorLimits kMotorLimits = {.q_lower_rad = -2.0, .q_upper_rad = 2.0, .dq_rad_s = 10.0, .torque_Nm = 50.0};

TEST(MotorMonitor, AMotorAtFullSpeedIsBelieved) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 100; ++k) {
    monitor.ask(k == 0);
    ASSERT_TRUE(monitor.hear({.q_rad = 15.0 * 0.002 * k, .dq_rad_s = 15.0}))
        << "1.5 times the limit is the control thread's fault";
  }
  EXPECT_EQ(monitor.condition(true), Condition::kGood);
}

TEST(MotorMonitor, ADamagedReadingIsDroppedAndThreeAreALostPosition) {
  MotorMonitor monitor(kMotorLimits);
  monitor.ask(true);
  monitor.hear({.q_rad = 0.1});
  for (const double bad : {1.0, std::numeric_limits<double>::quiet_NaN()}) {
    monitor.ask(false);
    EXPECT_FALSE(monitor.hear({.q_rad = bad}));
  }
  monitor.ask(false);
  EXPECT_TRUE(monitor.hear({.q_rad = 0.1}));
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
  for (int k = 0; k < 3; ++k) {
    monitor.ask(false);
    EXPECT_FALSE(monitor.hear({.q_rad = -1.5}));
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kPositionJump);
  EXPECT_EQ(monitor.reading().q_rad, 0.1);
}

TEST(MotorMonitor, ADamagedReadingIsNoAnswer) {
  MotorMonitor monitor(kMotorLimits);
  monitor.ask(true);
  monitor.hear({.q_rad = 0.1});
  for (int k = 0; k < 2; ++k) {
    monitor.ask(false);
    monitor.hear({.q_rad = 1.5});
  }
  EXPECT_EQ(monitor.age_cycles(), 2);
  EXPECT_EQ(monitor.condition(true), Condition::kLate);
}

TEST(MotorMonitor, TravelOfAFrozenEncoderCountsTheCyclesWithoutAnAnswerToo) {
  MotorMonitor monitor(kMotorLimits);
  int cycles = 0;
  while (monitor.trouble(false) != Trouble::kFrozenEncoder && cycles < 100) {  // an answer in every second cycle
    monitor.ask(cycles == 0);
    if (cycles++ % 2 == 0) monitor.hear({.q_rad = 0.3, .dq_rad_s = 6.0});
  }
  EXPECT_EQ(cycles, 11) << "0.024 rad from answer to answer: the fifth after the first is beyond 0.1 rad";
}

TEST(MotorMonitor, DamagedReadingsBetweenGoodOnesAreNoLostPosition) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 20; ++k) {
    monitor.ask(k == 0);
    EXPECT_EQ(monitor.hear({.q_rad = k % 2 == 0 ? 0.1 : 1.5}), k % 2 == 0) << k;
  }
  EXPECT_EQ(monitor.refused(), 10u);
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, BunchedAnswersAreNoSecondDriveAndASecondDriveIsFoundAllTheSame) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 6; ++k) monitor.ask(false);
  for (int k = 0; k < 6; ++k) monitor.hear({});
  EXPECT_EQ(monitor.uncalled(), 0u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(monitor.trouble(false), Trouble::kNone);
    monitor.ask(false);
    monitor.hear({});
    monitor.hear({});
  }
  EXPECT_EQ(monitor.trouble(false), Trouble::kTwoOfOneNode);
}

TEST(MotorMonitor, AMotorAtRestWithAnOffsetOfItsSpeedHasNoFrozenEncoder) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 10'000; ++k) {
    monitor.ask(k == 0);
    monitor.hear({.q_rad = 0.3, .dq_rad_s = MotorMonitor::kSpeedOffset_rad_s});
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, AMotorThatTurnsBackAndForthAFewStepsHasNoFrozenEncoder) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 1000; ++k) {  // it stands still for three cycles at a time: 0.018 rad at 3 rad/s
    monitor.ask(k == 0);
    monitor.hear({.q_rad = k / 4 % 2 == 0 ? 0.3 : 0.31, .dq_rad_s = 3.0});
  }
  EXPECT_EQ(monitor.trouble(true), Trouble::kNone);
}

TEST(MotorMonitor, ADriveIsEnabledOnlyByAnAnswerToItsRequest) {
  MotorMonitor monitor(kMotorLimits);
  monitor.ask(true);
  EXPECT_FALSE(monitor.enabled());
  monitor.hear({});
  EXPECT_TRUE(monitor.enabled());
  monitor.interrupt();
  monitor.ask(false);
  monitor.hear({});
  EXPECT_FALSE(monitor.enabled());
  EXPECT_EQ(monitor.trouble(true), Trouble::kNotEnabled);
  EXPECT_EQ(monitor.trouble(false), Trouble::kNone) << "limp anyway";
}

}  // namespace
}  // namespace pmg::drives
