// Keyboards, game controllers, pages and headsets obey the same rules: each row is a device, each test a rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gamepad/hands.hpp"
#include "operator/drive.hpp"
#include "operator/networked_robot.hpp"
#include "operator/operator_source.hpp"
#include "operator/robot_driver.hpp"
#include "pmg_msgs/mode_t.hpp"

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

  /// In 10 ms a thousand messages, as fast as comms receives them: others' commands and wishes, and bytes that are
  /// none.
  void flood(bool others_stand) {
    for (int part = 0; part < 10; ++part) {
      for (int k = 0; k < 10; ++k) {
        for (ops::OperatorSource& one : others_) {
          one.send_command("biped", Command{{-0.3}}, 2.0);
          if (others_stand) one.request("biped", pmg_msgs::mode_t::STAND, false);
        }
        for (const char* channel : {"COMMAND", "MODE", "ARMS", "CLAIM"}) network_.link.send(channel, junk_);
      }
      robot_.comms.step(0);
    }
  }

  const std::vector<std::uint8_t> junk_ = std::vector<std::uint8_t>(200, 0x5a);
  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  ops::OperatorSource source_{network_.link, "mine.1", 1, network_.clock};
  ops::OperatorSource other_{network_.link, "other.1", 1, network_.clock};
  std::array<ops::OperatorSource, 3> others_{ops::OperatorSource(network_.link, "flood.1", 1, network_.clock),
                                             ops::OperatorSource(network_.link, "flood.2", 1, network_.clock),
                                             ops::OperatorSource(network_.link, "flood.3", 1, network_.clock)};
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

TEST_P(DeviceRules, AStopDampsWithinFiftyMillisecondsWhileEverythingElseFloods) {
  stand();
  walk();
  for (int tick = 0; tick < 20; ++tick) {
    flood(true);
    step();
  }
  ASSERT_EQ(mode(), Mode::kWalk) << driver_.text();
  ASSERT_GT(robot_.comms.gate_counts().flooded, 1000);
  hand_->press_stop();
  const std::int64_t since_ns = network_.clock.now_ns();
  while (robot_.bus.last_command.kp.sum() != 0.0 && network_.clock.now_ns() - since_ns < 1'000'000'000) {
    flood(true);
    step();
  }
  EXPECT_LE(network_.clock.now_ns() - since_ns, 50'000'000);
  for (int tick = 0; tick < 20; ++tick) {
    flood(false);  // somebody who may would make it stand
    step();
    ASSERT_EQ(mode(), Mode::kDamping) << driver_.text();
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
