// A device is a mapping: the lever below drives, stops, loses its link and comes back over the machine alone.
#include "operator/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "networked_robot.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {
namespace {

using control::Mode;
using testing::HasSubstr;

/// A lever with a grip and two buttons, as a headset's controller or a page might have them.
class Lever : public Device {
 public:
  void squeeze() { grip_.down = grip_.pressed = true; }
  void let_go() { grip_.down = false; }
  void push(double share) { share_ = share; }
  void press_stop() { requests_.stop = true; }
  void press_stand() { requests_.other = Request::kStand; }
  bool connected = true;

  DeviceManner manner() const override {
    return {.name = "lever",
            .command_raises = false,
            .at_once = false,
            .raises = "the stand button makes it stand up",
            .resets = "nothing resets it",
            .drives = "the grip and the lever drive it",
            .starts = "the stand button makes it stand up",
            .anew = "Squeeze the grip anew"};
  }
  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }
  std::span<const Hold> holds(std::int64_t now_ns) noexcept override {
    if (connected) grip_.heard_ns = now_ns;
    grip_.neutral = share_ == 0.0;
    shown_ = std::exchange(grip_, {0, grip_.down, false, grip_.neutral, false, grip_.heard_ns});
    return {&shown_, 1};
  }
  Command command(std::optional<std::int32_t> /*armed*/, std::int64_t /*now_ns*/) noexcept override {
    return Command{{share_ * limits_.upper[kVx]}};
  }
  Requests take_requests() noexcept override { return std::exchange(requests_, {}); }
  void rest() noexcept override {}
  void upright() noexcept override {}

 private:
  CommandLimits limits_;
  Hold grip_{}, shown_{};
  Requests requests_{};
  double share_ = 0.0;
};

class DeviceTest : public testing::Test {
 protected:
  DeviceTest() {
    driver_.set_limits(robot_.robot.command_limits);
    run(0.3);
  }
  void step() {
    network_.advance();
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  Mode mode() const { return robot_.result().mode; }
  double vx() const { return robot_.result().reference.command[kVx]; }
  void stand() {
    lever_.press_stand();
    run(4.0);
    ASSERT_EQ(mode(), Mode::kStand) << driver_.text();
  }
  void squeeze_and_push() {
    lever_.squeeze();
    step();
    lever_.push(1.0);
    run(2.0);
  }
  void expect_walks() {
    EXPECT_EQ(mode(), Mode::kWalk) << driver_.text();
    EXPECT_GT(vx(), 0.0);
  }
  void expect_comes_to_rest() {
    run(0.6);
    EXPECT_EQ(vx(), 0.0);
    run(1.5);
    EXPECT_EQ(mode(), Mode::kStand) << driver_.text();
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  OperatorSource source_{network_.link, "lever.1", 1, network_.clock};
  OperatorSource other_{network_.link, "pmg_send.2", 1, network_.clock};
  Lever lever_;
  RobotDriver driver_{source_, "biped", lever_};
};

TEST_F(DeviceTest, ALeverStandsDrivesAndComesToRestWhenItsGripIsLetGo) {
  lever_.squeeze();
  run(1.0);
  EXPECT_EQ(mode(), Mode::kPassive) << "a grip raises no robot";
  lever_.let_go();
  step();
  stand();
  squeeze_and_push();
  expect_walks();
  lever_.let_go();
  expect_comes_to_rest();
  run(1.0);
  EXPECT_EQ(robot_.result().driving, control::Source{}) << "an idle lever is in nobody's way";
}

TEST_F(DeviceTest, ALeverThatIsPushedWithoutItsGripOrBeforeItMovesNothing) {
  stand();
  lever_.push(1.0);
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "no grip";
  lever_.squeeze();
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "not neutral when the grip was squeezed";
  EXPECT_TRUE(driver_.hold().refused(0));
  lever_.push(0.0);
  lever_.let_go();
  step();
  squeeze_and_push();
  expect_walks();
}

TEST_F(DeviceTest, ItsStopGoesOutBeforeAnyoneWaitsAndOnlyStandRaisesTheRobotAgain) {
  stand();
  squeeze_and_push();
  lever_.press_stop();
  driver_.heed();
  network_.advance();
  EXPECT_EQ(robot_.bus.last_command.kp.sum(), 0.0) << "on the bus, within one tick";
  run(1.0);
  EXPECT_EQ(mode(), Mode::kDamping);
  lever_.push(0.0);
  lever_.let_go();
  step();
  squeeze_and_push();
  EXPECT_EQ(mode(), Mode::kDamping);
  lever_.push(0.0);
  lever_.let_go();
  stand();
  squeeze_and_push();
  expect_walks();
}

TEST_F(DeviceTest, ASqueezeAtTheSameMomentAsAStopDoesNotDrive) {
  stand();
  lever_.press_stop();
  lever_.squeeze();
  step();
  EXPECT_FALSE(driver_.hold().armed());
  lever_.press_stand();
  lever_.squeeze();
  step();
  EXPECT_FALSE(driver_.hold().armed()) << "nor at the same moment as a request to stand";
}

TEST_F(DeviceTest, ALeverThatIsNoLongerHeardStopsAndNeedsAFreshSqueezeWhenItIsBack) {
  stand();
  squeeze_and_push();
  lever_.connected = false;
  run(HoldToDrive::kDeaf_ns * 1e-9);
  expect_comes_to_rest();
  lever_.connected = true;
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "the old squeeze doesn't count again";
  lever_.let_go();
  lever_.push(0.0);
  step();
  squeeze_and_push();
  expect_walks();
}

TEST_F(DeviceTest, AControllerThatFallsSilentAndComesBackIsNotDrivenOn) {
  stand();
  squeeze_and_push();
  network_.comms_alive = false;
  run(1.0);
  EXPECT_THAT(driver_.text(), HasSubstr("no longer heard"));
  network_.comms_alive = true;
  run(3.0);
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_FALSE(driver_.hold().armed());
  lever_.let_go();
  lever_.push(0.0);
  step();
  squeeze_and_push();
  expect_walks();
}

TEST_F(DeviceTest, ARequestThatAnAbsentControllerDidNotHearDoesNotWaitForIt) {
  network_.comms_alive = false;
  run(1.0);
  lever_.press_stand();
  run(1.0);
  EXPECT_THAT(driver_.text(), HasSubstr("no longer heard"));
  network_.comms_alive = true;
  run(3.0);
  EXPECT_EQ(mode(), Mode::kPassive);
}

TEST_F(DeviceTest, AStopIsRepeatedUntilItIsAnsweredAndNothingIsAskedBefore) {
  stand();
  robot_.acks_lost = true;
  lever_.press_stop();
  run(0.2);
  EXPECT_EQ(mode(), Mode::kDamping);
  lever_.press_stand();
  run(1.0);
  EXPECT_EQ(mode(), Mode::kDamping) << "nothing is asked before the stop is answered";
  robot_.acks_lost = false;
  run(0.2);
  stand();
}

TEST_F(DeviceTest, WhatTheControllerCannotFollowIsToldWhileItIsAskedFor) {
  stand();
  RobotBoard board(network_.link, network_.clock);
  run(1.1);
  lever_.squeeze();
  step();
  lever_.push(3.0);
  for (int k = 0; k < 300; ++k) {
    network_.advance();
    driver_.step(&board.robots().at("biped"));
  }
  EXPECT_THAT(driver_.limited(), HasSubstr("limited: vx "));
  lever_.push(0.5);
  for (int k = 0; k < 300; ++k) {
    network_.advance();
    driver_.step(&board.robots().at("biped"));
  }
  EXPECT_EQ(driver_.limited(), "");
}

}  // namespace
}  // namespace pmg::ops
