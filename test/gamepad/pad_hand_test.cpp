// When a game controller drives, stops and acts: deadman, stop, chords, silence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gamepad/pad_command_fixture.hpp"

namespace pmg::gamepad {
namespace {

TEST_F(PadCommandTest, TheDeadmanArmsWithNeutralSticksOnly) {
  for (const std::size_t axis : {kLeftX, kLeftY, kRightX, kRightY}) {
    pads_.clear();
    step();
    PadReport& pad = plug_in(static_cast<std::int32_t>(axis) + 1);
    step();
    pad.state.axes[axis] = 0.4;
    press(pad, kLb);
    run(0.2);
    EXPECT_FALSE(driving()) << axis;
    EXPECT_TRUE(rule_.refused(pad.id));
    pad.state.axes[axis] = 0.0;
    run(0.2);
    EXPECT_FALSE(driving()) << "neutral now, but the press is old";
    arm(pad);
  }
}

TEST_F(PadCommandTest, ADeadmanThatWasDownWhenThePadCameDoesNotArm) {
  PadReport& pad = plug_in(1);
  press(pad, kLb);
  run(0.5);
  EXPECT_FALSE(driving());
}

TEST_F(PadCommandTest, APauseOfTheProgramDisarms) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  now_ns_ += 280'000'000;
  step();
  EXPECT_TRUE(driving());
  now_ns_ += 300'000'000;
  step();
  EXPECT_FALSE(driving());
  run(0.5);
  EXPECT_FALSE(driving()) << "the old press doesn't count again";
  arm(pad);
}

TEST_F(PadCommandTest, TheSecondPadDrivesOnlyAfterAPressOfItsOwn) {
  PadReport &first = plug_in(1), &second = plug_in(2);
  step();
  arm(first);
  press(second, kLb);
  EXPECT_EQ(driving(), 1);
  second.state.axes[kLeftY] = -1.0;
  run(0.3);
  EXPECT_EQ(u(kVx), 0.0) << "the second pad's sticks mean nothing";
  second.state.axes[kLeftY] = 0.0;
  let_go(first, kLb);
  run(0.3);
  EXPECT_FALSE(driving()) << "the second one was pressed while the first drove";
  arm(second);
}

TEST_F(PadCommandTest, TheStopOfAPadThatDoesNotDriveDisarmsTheOneThatDoes) {
  PadReport &first = plug_in(1), &second = plug_in(2);
  step();
  arm(first);
  first.state.axes[kLeftY] = -1.0;
  run(0.6);
  ASSERT_EQ(stops_, 0);
  press(second, kB);
  EXPECT_EQ(stops_, 1);
  EXPECT_FALSE(driving());
  EXPECT_EQ(u(kVx), 0.0);
  run(0.5);
  EXPECT_EQ(stops_, 1) << "once for each press";
  EXPECT_EQ(u(kVx), 0.0) << "the deadman must be pressed anew";
}

TEST_F(PadCommandTest, AStopThatIsDownWhenThePadComesStops) {
  plug_in(1).state.held[kB] = true;
  before_[1] = pads_.front().state.held;  // no event tells the press
  step();
  EXPECT_EQ(stops_, 1);
}

TEST_F(PadCommandTest, TheLastStateOfAPadThatIsUnpluggedStopsStillAndDrivesNoMore) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  pad.state.held[kB] = true;
  pad.gone = true;
  step();
  EXPECT_EQ(stops_, 1);
  EXPECT_FALSE(driving());
}

TEST_F(PadCommandTest, APadThatIsUnpluggedDrivesNoMore) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  pad.state.axes[kLeftY] = -1.0;
  run(0.3);
  pad.gone = true;
  step();
  EXPECT_FALSE(driving());
  EXPECT_EQ(u(kVx), 0.0);
}

TEST_F(PadCommandTest, AButtonThatIsLetGoAndPressedBetweenTwoStepsIsAFreshPress) {
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  pad.state.axes[kLeftY] = -1.0;
  step();
  flicked_.set(kLb);
  step();
  EXPECT_FALSE(driving()) << "a fresh press of the deadman with a stick out";
  pad.state.axes[kLeftY] = 0.0;
  let_go(pad, kLb);
  press(pad, kRb);
  press(pad, kA);
  run(0.7);
  flicked_.set(kA);
  run(0.7);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "the chord begins anew";
}

TEST_F(PadCommandTest, AStopInTheSameStepIsStrongerThanAChord) {
  PadReport &first = plug_in(1), &second = plug_in(2);
  step();
  press(first, kRb);
  press(first, kA);
  run(0.99);
  press(second, kB);  // 1.00 s after the chord began
  run(0.5);
  EXPECT_EQ(stops_, 1);
  EXPECT_THAT(actions_, testing::IsEmpty());
}

TEST_F(PadCommandTest, AChordActsOnceAfterItsTimeAndNotBefore) {
  PadReport& pad = plug_in(1);
  step();
  press(pad, kRb);
  press(pad, kA);
  run(0.97);
  EXPECT_THAT(actions_, testing::IsEmpty());
  run(0.05);
  EXPECT_THAT(actions_, testing::ElementsAre(ops::Request::kStand));
  run(3.0);
  EXPECT_EQ(actions_.size(), 1U);
}

TEST_F(PadCommandTest, AChordThatIsBrokenBeginsAnew) {
  PadReport& pad = plug_in(1);
  step();
  press(pad, kRb);
  press(pad, kA);
  run(0.7);
  let_go(pad, kA);
  press(pad, kA);
  run(0.7);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "let go and pressed again";
  press(pad, kX);
  let_go(pad, kX);
  run(0.7);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "one button too many";
  pad.state.axes[kLeftY] = 0.5;
  step();
  pad.state.axes[kLeftY] = 0.0;
  run(0.7);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "a stick was out";
  now_ns_ += 600'000'000;
  run(0.7);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "the program paused";
  run(0.4);
  EXPECT_THAT(actions_, testing::ElementsAre(ops::Request::kStand));
}

TEST_F(PadCommandTest, AChordMeansNothingWhileAPadDrivesNorIfItWasDownWhenThePadCame) {
  PadReport &first = plug_in(1), &second = plug_in(2);
  second.state.held[kRb] = second.state.held[kA] = true;
  run(2.0);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "down when it came";
  arm(first);
  let_go(second, kA);
  let_go(second, kRb);
  press(second, kRb);
  press(second, kA);
  run(2.0);
  EXPECT_THAT(actions_, testing::IsEmpty()) << "the other pad drives";
}

TEST_F(PadCommandTest, OnlySticksThatAreOutNeedASignOfLife) {
  lively_ = false;
  PadReport& pad = plug_in(1);
  step();
  arm(pad);
  run(10.0);
  EXPECT_TRUE(driving()) << "neutral sticks may rest";
  pad.state.axes[kLeftY] = -1.0;
  pad.state.changed = true;
  run(1.4);
  EXPECT_STREQ(command_.text(1), "");
  run(0.2);
  EXPECT_THAT(command_.text(1), testing::HasSubstr("move a stick"));
  run(1.35);
  EXPECT_TRUE(driving());
  run(0.1);
  EXPECT_FALSE(driving());
  EXPECT_EQ(u(kVx), 0.0);
  EXPECT_THAT(command_.text(1), testing::HasSubstr("may be lost"));
  pad.state.changed = true;
  run(0.2);
  EXPECT_FALSE(driving()) << "a pad that comes back needs a fresh press";
}

}  // namespace
}  // namespace pmg::gamepad
