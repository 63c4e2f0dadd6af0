// Keyboards, game controllers, pages and headsets obey the same rules: each row is a device, each test a rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "gamepad/hands.hpp"
#include "operator/drive.hpp"
#include "operator/networked_robot.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::gamepad {
namespace {

using control::Mode;
using testing::HasSubstr;

struct Row {
  const char* name;
  std::function<std::unique_ptr<Hand>(const io::Clock&)> make;
};

class DeviceRules : public testing::TestWithParam<Row> {
 protected:
  DeviceRules() {
    driver_.set_limits(robot_.robot.command_limits);
    run(0.3);
  }
  void step() {
    network_.advance();
    hand_->poll();
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  Mode mode() const { return robot_.result().mode; }
  double vx() const { return robot_.result().reference.command[kVx]; }
  void ask(void (Hand::*request)(bool)) {
    (*hand_.*request)(true);
    run(1.1);
    (*hand_.*request)(false);
    run(0.1);
  }
  void stand() {
    ask(&Hand::ask_stand);
    run(4.0);
    ASSERT_EQ(mode(), Mode::kStand) << driver_.text();
  }
  void walk() {
    hand_->go(true);
    run(3.0);
    ASSERT_EQ(mode(), Mode::kWalk) << driver_.text();
    ASSERT_GT(vx(), 0.0);
  }
  /// Still held, the device moves nothing; after a fresh press it does.
  void expect_fresh_press_needed() {
    run(2.0);
    EXPECT_EQ(mode(), Mode::kStand) << driver_.text();
    EXPECT_EQ(vx(), 0.0);
    hand_->go(false);
    run(0.1);
    walk();
  }
  void expect_stays(Mode expected, double seconds) {
    for (; seconds > 0.0; seconds -= 0.01) {
      step();
      ASSERT_EQ(mode(), expected) << driver_.text();
    }
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  ops::OperatorSource source_{network_.link, "mine.1", 1, network_.clock};
  ops::OperatorSource other_{network_.link, "other.1", 1, network_.clock};
  std::unique_ptr<Hand> hand_ = GetParam().make(network_.clock);
  ops::RobotDriver driver_{source_, "biped", hand_->device()};
};

TEST_P(DeviceRules, AStopDampsWithinTwoTicksInEveryStateAndOnlyStandRaisesTheRobotAgain) {
  for (const double driven_s : {-1.0, 0.0, 0.05, 0.3, 3.0}) {
    stand();
    if (driven_s >= 0.0) hand_->go(true);
    run(std::max(driven_s, 0.0));
    hand_->press_stop();
    for (int k = 0; k < 3 && mode() != Mode::kDamping; ++k) step();
    EXPECT_EQ(mode(), Mode::kDamping) << driven_s;
    expect_stays(Mode::kDamping, 0.5);
    hand_->go(false);
    run(0.1);
    hand_->go(true);
    expect_stays(Mode::kDamping, 1.0);
    hand_->go(false);
    run(0.1);
  }
}

TEST_P(DeviceRules, WhatIsLetGoOfBringsVelocityToZeroThenStandAndFreesTheRobot) {
  stand();
  walk();
  hand_->go(false);
  run(0.55);
  EXPECT_EQ(vx(), 0.0);
  run(2.0);
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_EQ(robot_.result().driving, control::Source{});
}

TEST_P(DeviceRules, ADeviceThatIsLostStopsAndWhatIsStillHeldWhenItIsBackDoesNotCount) {
  stand();
  walk();
  hand_->leave();
  run(0.3 + 0.55);
  EXPECT_EQ(vx(), 0.0);
  run(2.0);
  EXPECT_EQ(mode(), Mode::kStand);
  hand_->come_back();
  expect_fresh_press_needed();
}

TEST_P(DeviceRules, AProgramThatPausedDoesNotDriveOn) {
  stand();
  walk();
  for (int k = 0; k < 40; ++k) network_.advance();
  expect_fresh_press_needed();
}

TEST_P(DeviceRules, AControllerThatWasSilentIsNotDrivenOn) {
  stand();
  walk();
  network_.comms_alive = false;
  run(1.0);
  EXPECT_THAT(driver_.text(), HasSubstr("no longer heard"));
  network_.comms_alive = true;
  run(1.0);
  expect_fresh_press_needed();
}

TEST_P(DeviceRules, WhileAnotherDrivesTheRefusalIsToldAndAFreshPressIsNeededAfterwards) {
  stand();
  ops::Drive drive(other_, "biped", Command{{0.3}}, {.duration_s = 3.0, .climb = true});
  while (!drive.driving()) {
    step();
    drive.step();
  }
  hand_->go(true);
  std::string told;
  for (auto progress = ops::Progress::kPending; progress == ops::Progress::kPending;) {
    step();
    progress = drive.step();
    if (driver_.text().find("another source drives: other.1") != std::string::npos) told = driver_.text();
    EXPECT_NE(robot_.result().driving, control::Source::make("mine.1", 1));
  }
  EXPECT_EQ(drive.text(), "");
  EXPECT_NE(told, "");
  expect_fresh_press_needed();
}

TEST_P(DeviceRules, AnothersStopIsNotOverruledByWhatIsHeld) {
  stand();
  walk();
  const ops::ModeWish stop(other_, "biped", ops::Goal::kStop, 2.0);
  run(0.2);
  expect_stays(Mode::kDamping, 2.0);
  EXPECT_THAT(driver_.text(), HasSubstr("somebody stopped it"));
  hand_->go(false);
  run(0.1);
  stand();
  walk();
}

TEST_P(DeviceRules, AFaultIsToldAndNeedsItsResetThenStand) {
  stand();
  walk();
  robot_.policy->how = test::BreakablePolicy::Break::kNotANumber;
  run(0.2);
  ASSERT_EQ(mode(), Mode::kFault);
  EXPECT_THAT(driver_.text(), HasSubstr("fault: "));
  robot_.policy->how = test::BreakablePolicy::Break::kNone;
  hand_->go(false);
  run(0.1);
  ask(&Hand::ask_reset);
  EXPECT_EQ(mode(), Mode::kDamping);
  hand_->go(true);
  expect_stays(Mode::kDamping, 1.0);
  hand_->go(false);
  run(0.1);
  stand();
  walk();
}

INSTANTIATE_TEST_SUITE_P(
    Devices, DeviceRules,
    testing::Values(
        Row{"keyboard", [](const io::Clock& clock) -> std::unique_ptr<Hand> { return std::make_unique<Keys>(clock); }},
        Row{"gamepad", [](const io::Clock& clock) -> std::unique_ptr<Hand> { return std::make_unique<Pad>(clock); }},
        Row{"page", [](const io::Clock& clock) -> std::unique_ptr<Hand> { return std::make_unique<Finger>(clock); }},
        Row{"headset", [](const io::Clock& clock) -> std::unique_ptr<Hand> { return std::make_unique<Head>(clock); }}),
    [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace pmg::gamepad
