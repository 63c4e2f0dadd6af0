#include <gtest/gtest.h>

#include <limits>

#include "generator_core/synthetic_library.hpp"
#include "pmg/command_limiter.hpp"

namespace pmg::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class CommandLimiterTest : public ::testing::Test {
 protected:
  CommandLimits limits = make_options().limits;
  CommandLimiter limiter{limits, 0.15, 0.5, 0.1};

  Command hold(const Command& user, double double_support, double duration_s) {
    Command command;
    for (int i = 0; i < std::lround(duration_s / kDt_s); ++i) command = limiter.step(user, double_support, kDt_s);
    return command;
  }
};

TEST_F(CommandLimiterTest, EveryChannelStaysInItsRangeAndWithinItsRate) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-2.0, 2.0), share(0.0, 1.0);
  Command user, previous;
  for (int tick = 0; tick < 5000; ++tick) {
    if (tick % 37 == 0) {
      for (double& u : user.u) u = any(random);
    }
    const Command command = limiter.step(user, share(random), kDt_s);
    for (std::size_t c = 0; c < kChannels; ++c) {
      ASSERT_GE(command.u[c], limits.lower[c]);
      ASSERT_LE(command.u[c], limits.upper[c]);
      ASSERT_LE(std::abs(command.u[c] - previous.u[c]), limits.rate_per_s[c] * kDt_s + 1e-12);
    }
    previous = command;
  }
}

TEST_F(CommandLimiterTest, ReachesWhatIsAskedAndSaysWhenItCannot) {
  EXPECT_EQ(hold(make_command(0.3, -0.2, 0.4, 0.1, -0.1, -0.1), 0.0, 3.0),
            make_command(0.3, -0.2, 0.4, 0.1, -0.1, -0.1));
  EXPECT_FALSE(limiter.limited());
  EXPECT_EQ(hold(make_command(2.0, 0, 0), 0.0, 3.0)[kVx], limits.upper[kVx]);
  EXPECT_TRUE(limiter.limited());
}

TEST_F(CommandLimiterTest, VelocityHardlyChangesWhileBothFeetAreLoadedAndPostureGoesOn) {
  const Command in_double_support = hold(make_command(0.8, 0, 0, 0.5), 1.0, 0.5);
  EXPECT_NEAR(in_double_support[kVx], 0.15 * 0.8 * 0.5, 1e-12);
  EXPECT_NEAR(in_double_support[kPitch], 0.4 * 0.5, 1e-12);
  limiter.reset();
  EXPECT_NEAR(hold(make_command(0.8, 0, 0), 0.0, 0.5)[kVx], 0.8 * 0.5, 1e-12);
  limiter.reset();
  EXPECT_NEAR(hold(make_command(0.8, 0, 0), 0.5, 0.5)[kVx], 0.575 * 0.8 * 0.5, 1e-12);
}

TEST_F(CommandLimiterTest, StopReachesExactlyZeroWithinHalfASecondEvenWhereTheRateIsSlowAndBothFeetAreLoaded) {
  limits.rate_per_s = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
  limiter = CommandLimiter(limits, 0.15, 0.5, 0.1);
  hold(make_command(0.8, -0.35, 0.8), 0.0, 20.0);
  Command previous = limiter.step(make_command(0.8, -0.35, 0.8), 0.0, kDt_s);
  ASSERT_NEAR(previous[kVx], 0.8, 1e-12);
  for (int tick = 0; tick < 50; ++tick) {
    const Command command = limiter.step(Command{}, 1.0, kDt_s);
    // A ramp without a jump: never faster than the initial speed divided by the time to stop.
    ASSERT_LE(std::abs(command[kVx] - previous[kVx]), 0.8 / 0.5 * kDt_s + 1e-9) << tick;
    previous = command;
  }
  for (const Channel channel : {kVx, kVy, kOmega}) EXPECT_EQ(previous[channel], 0.0);
}

TEST_F(CommandLimiterTest, StopIsNotSlowerThanTheUsualRate) {
  hold(make_command(0.1, 0, 0), 0.0, 2.0);
  EXPECT_EQ(hold(Command{}, 0.0, 0.13)[kVx], 0.0);  // 0.1 m/s at 0.8 m/s^2 is 0.125 s
}

TEST_F(CommandLimiterTest, OneChannelBackToZeroWhileAnotherMovesIsNoStop) {
  hold(make_command(0.8, 0.35, 0), 0.0, 3.0);
  const Command command = hold(make_command(0.8, 0, 0), 1.0, 0.5);
  EXPECT_NEAR(command[kVy], 0.35 - 0.15 * 0.5 * 0.5, 1e-12);
}

TEST_F(CommandLimiterTest, ACommandThatFlickersChangesItsRateByATenthOfTheLimit) {
  const Command one = make_command(0.8, -0.35, 0.8, 0.5, -0.25, 0.02),
                other = make_command(-0.5, 0.35, -0.8, -0.15, 0.25, -0.2);
  Command previous = hold(one, 0.0, 0.3);
  limiter.step(other, 0.0, kDt_s);
  previous = limiter.step(one, 0.0, kDt_s);
  for (int tick = 0; tick < 500; ++tick) {
    const Command command = limiter.step(tick % 2 == 0 ? other : one, 0.0, kDt_s);
    for (std::size_t c = 0; c < kChannels; ++c) {
      // dt / turn_s of the limit, each way.
      ASSERT_LE(std::abs(command.u[c] - previous.u[c]), 0.1 * limits.rate_per_s[c] * kDt_s + 1e-12) << tick;
    }
    previous = command;
  }
}

TEST_F(CommandLimiterTest, ACommandThatTurnsHasItsFullRateBackAfterATenthOfASecond) {
  hold(make_command(0.8, 0, 0), 0.0, 0.5);
  hold(make_command(-0.5, 0, 0), 0.0, 0.1);
  const double before = limiter.step(make_command(-0.5, 0, 0), 0.0, kDt_s)[kVx];
  EXPECT_NEAR(limiter.step(make_command(-0.5, 0, 0), 0.0, kDt_s)[kVx], before - 0.8 * kDt_s, 1e-12);
}

TEST_F(CommandLimiterTest, ACommandThatRestedBeforeItTurnsHasItsFullRateAtOnce) {
  const double before = hold(make_command(0.3, 0, 0), 0.0, 1.0)[kVx];
  EXPECT_NEAR(limiter.step(make_command(-0.5, 0, 0), 0.0, kDt_s)[kVx], before - 0.8 * kDt_s, 1e-12);
}

TEST_F(CommandLimiterTest, AStopInTheMiddleOfARiseStillReachesZeroWithinItsTime) {
  limits.rate_per_s = {0.8, 0.5, 1.0, 0.1, 0.1, 0.1};
  hold(make_command(0.8, -0.35, 0.8), 0.0, 0.6);
  const Command stopped = hold(Command{}, 1.0, 0.5);
  for (const Channel channel : {kVx, kVy, kOmega}) EXPECT_EQ(stopped[channel], 0.0);
}

TEST_F(CommandLimiterTest, ChannelThatIsNotFiniteKeepsItsLastTarget) {
  hold(make_command(0.3, 0.1, 0.2, 0.1, 0.05, -0.1), 0.0, 0.1);
  const Command command = hold(make_command(kNaN, kInfinity, -kInfinity, kNaN, 0.05, kNaN), 0.0, 3.0);
  EXPECT_EQ(command, make_command(0.3, 0.1, 0.2, 0.1, 0.05, -0.1));
  EXPECT_TRUE(limiter.limited());
}

TEST(Generator, StopsWithinHalfASecondFromAnyCommandAtAnyPhase) {
  const ClipLibrary library = make_library(7);
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    Generator generator(library, make_options());
    run(generator, make_command(any(random), any(random), any(random), any(random)), 2.0 + 0.02 * trial);
    ASSERT_GT(generator.reference().gain, 0.0);
    EXPECT_EQ(run(generator, Command{}, 0.5).gain, 0.0) << "trial " << trial;
  }
}

TEST(Generator, GainsHardlyChangeInDoubleSupportButAtFullRateInSingleSupport) {
  Generator generator(make_library(7), make_options());
  double previous = 0.0, single = 0.0;
  PerFoot<double> loaded = generator.reference().contact_weight;
  while (generator.reference().gain < 0.999) {
    const Reference& r = generator.step(make_command(0.8, 0, 0), kDt_s);
    const double rate = (r.gain - previous) / kDt_s;
    if (loaded[kLeft] * loaded[kRight] == 1.0) {
      ASSERT_LE(rate, 0.15 * 0.8 / 0.8 + 1e-9);
    }
    if (loaded[kLeft] * loaded[kRight] == 0.0) single = std::max(single, rate);
    previous = r.gain;
    loaded = r.contact_weight;
  }
  EXPECT_NEAR(single, 0.8 / 0.8, 1e-9);
}

TEST(Generator, NeverPropagatesWhatIsNotFinite) {
  Generator generator(make_library(7), make_options());
  run(generator, make_command(0.4, 0, 0, 0.1), 1.0);
  for (int tick = 0; tick < 200; ++tick) {
    const Reference& r = generator.step(make_command(kNaN, -kInfinity, kNaN, kInfinity, kNaN, kNaN), kDt_s);
    ASSERT_TRUE(r.q.allFinite() && r.dq.allFinite());
    ASSERT_TRUE(r.command_limited);
  }
  EXPECT_NEAR(generator.reference().command[kVx], 0.4, 1e-12);
  EXPECT_NEAR(generator.reference().command[kPitch], 0.1, 1e-12);
}

}  // namespace
}  // namespace pmg::test
