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

TEST(MotorMonitor, AMotorAtRestWithAnOffsetOfItsSpeedHasNoFrozenEncoder) {
  MotorMonitor monitor(kMotorLimits);
  for (int k = 0; k < 10'000; ++k) {
    monitor.ask(k == 0);
    monitor.hear({.q_rad = 0.3, .dq_rad_s = MotorMonitor::kSpeedOffset_rad_s});
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
