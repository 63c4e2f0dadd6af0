// (sticks of game controllers) => a command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "gamepad/pad_command_fixture.hpp"

namespace pmg::gamepad {
namespace {

TEST_F(PadCommandTest, EveryStickReachesBothEndsOfItsRangeInItsDirection) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  struct Way {
    std::size_t axis;
    double out;
    std::size_t channel;
    double end;
  };
  for (const Way& way : std::vector<Way>{{kLeftY, -1.0, kVx, 0.8},
                                         {kLeftY, 1.0, kVx, -0.5},
                                         {kLeftX, -1.0, kVy, 0.3},
                                         {kLeftX, 1.0, kVy, -0.2},
                                         {kRightX, -1.0, kOmega, 0.9},
                                         {kRightX, 1.0, kOmega, -0.7}}) {
    pad.state.axes[way.axis] = way.out;
    run(0.6);
    for (std::size_t i = 0; i < kChannels; ++i) EXPECT_DOUBLE_EQ(u(i), i == way.channel ? way.end : 0.0) << i;
    pad.state.axes[way.axis] = 0.0;
    step();
    EXPECT_EQ(u(way.channel), 0.0) << "a stick that is let go brakes at once";
  }
  press(pad, kRb);
  for (const Way& way : std::vector<Way>{{kRightY, -1.0, kPitch, 0.4},
                                         {kRightY, 1.0, kPitch, -0.1},
                                         {kRightX, 1.0, kRoll, 0.25},
                                         {kRightX, -1.0, kRoll, -0.15},
                                         {kLeftY, -1.0, kHeight, 0.05},
                                         {kLeftY, 1.0, kHeight, -0.3}}) {
    pad.state.axes[way.axis] = way.out;
    run(9.0);  // the longest way, 0.5 rad at 0.1 rad in 1.5 s, takes 7.5 s
    EXPECT_DOUBLE_EQ(u(way.channel), way.end);
    EXPECT_EQ(u(kVx), 0.0) << "a stick that bends doesn't drive";
    EXPECT_EQ(u(kOmega), 0.0);
    pad.state.axes[way.axis] = 0.0;
    run(1.0);
    EXPECT_DOUBLE_EQ(u(way.channel), way.end) << "a posture stays";
  }
  let_go(pad, kRb);
  EXPECT_DOUBLE_EQ(u(kPitch), -0.1);
  press(pad, kUp);
  for (std::size_t i = kVelocityChannels; i < kChannels; ++i) EXPECT_EQ(u(i), 0.0);
}

TEST_F(PadCommandTest, ASideStepGoesOnWhileTheOtherSticksBend) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  press(pad, kRb);
  pad.state.axes[kLeftX] = -1.0;
  run(1.0);
  EXPECT_DOUBLE_EQ(u(kVy), 0.3);
}

TEST_F(PadCommandTest, VelocityGrowsWithItsSlewLimitAndBrakesAtOnce) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  pad.state.axes[kLeftY] = -1.0;
  run(0.25);
  EXPECT_NEAR(u(kVx), 0.4, 0.8 * kStep_s / 0.5 + 1e-9) << "half of 0.8 in half of 0.5 s, within a step";
  run(0.3);
  EXPECT_DOUBLE_EQ(u(kVx), 0.8);
  pad.state.axes[kLeftY] = 1.0;
  step();
  EXPECT_LT(u(kVx), 0.0) << "through zero at once";
  EXPECT_GT(u(kVx), -0.5 * kStep_s / 0.5 - 1e-9) << "and from zero with the limit";
}

TEST_F(PadCommandTest, PosturesMoveInTheirTime) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  press(pad, kRb);
  pad.state.axes[kRightY] = -1.0;
  run(0.75);
  EXPECT_NEAR(u(kPitch), 0.2, 0.4 * kStep_s / 1.5 + 1e-9) << "half of 0.4 rad in half of 1.5 s, within a step";
}

TEST_F(PadCommandTest, AtRestItAsksForNothing) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  pad.state.axes[kLeftY] = -1.0;
  run(0.5);
  EXPECT_GT(u(kVx), 0.0);
  rest();
  run(0.5);
  EXPECT_FALSE(driving());
  EXPECT_EQ(u(kVx), 0.0);
}

TEST(PadCommandWithoutLimits, CommandsNothing) {
  PadCommand command(read_mapping(find_mapping("standard")));
  PadReport pad{.id = 1};
  command.take(std::array{pad}, 0);
  pad.state.held.set(9);  // leftshoulder
  command.take(std::array{pad}, 10'000'000);
  pad.state.axes[1] = -1.0;  // lefty
  pad.state.changed = true;
  for (std::int64_t t_ns = 20'000'000; t_ns < 500'000'000; t_ns += 10'000'000) command.take(std::array{pad}, t_ns);
  EXPECT_EQ(command.command(1, 500'000'000), Command{});
}

}  // namespace
}  // namespace pmg::gamepad
