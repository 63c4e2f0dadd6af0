// Keyboards and game controllers obey the same rules: each row is a device, each test a rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "gamepad/pad_command.hpp"
#include "keyboard/key_command.hpp"
#include "operator/drive.hpp"
#include "operator/networked_robot.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::gamepad {
namespace {

using control::Mode;
using testing::HasSubstr;

/// A device in a hand: what the hand does, and the machine that it drives by.
class Hand {
 public:
  explicit Hand(const io::Clock& clock) : clock_(clock) {}
  virtual ~Hand() = default;
  Hand(const Hand&) = delete;
  Hand& operator=(const Hand&) = delete;
  virtual ops::Device& device() = 0;
  virtual void poll() = 0;         ///< the program looks at the device
  virtual void go(bool held) = 0;  ///< begins or ends to hold what drives forwards
  virtual void press_stop() = 0;
  virtual void ask_stand(bool held) = 0;  ///< begins or ends
  virtual void ask_reset(bool held) = 0;
  virtual void leave() = 0;      ///< unplugged, or its window is closed
  virtual void come_back() = 0;  ///< with what was held still held

 protected:
  const io::Clock& clock_;
};

class Keys : public Hand {
 public:
  using Hand::Hand;
  ops::Device& device() override { return keys_; }
  void poll() override {
    if (!there_) return;
    keys_.listen(clock_.now_ns());
    if (held_) keys_.repeat("w", true, clock_.now_ns());
  }
  void go(bool held) override {
    held_ = held;
    if (held) keys_.press("w", true, clock_.now_ns());
    if (!held) keys_.release("w", clock_.now_ns());
  }
  void press_stop() override { keys_.press("escape", false, clock_.now_ns()); }
  void ask_stand(bool held) override {
    if (held) keys_.press("enter", false, clock_.now_ns());
  }
  void ask_reset(bool held) override {
    if (held) keys_.press("r", false, clock_.now_ns());
  }
  void leave() override { there_ = false; }
  void come_back() override { there_ = true; }

 private:
  ops::KeyCommand keys_{ops::KeyReport::kPressAndRelease};
  bool held_ = false, there_ = true;
};

class Pad : public Hand {
 public:
  using Hand::Hand;
  ops::Device& device() override { return command_; }
  void poll() override {
    pad_.state.pressed = pad_.state.held & ~before_;
    before_ = pad_.state.held;
    if (there_) {
      command_.take({&pad_, 1}, clock_.now_ns());
    } else {
      command_.take({}, clock_.now_ns());
    }
    pad_.state.changed = true;
    if (pad_.state.held[kLb] && wants_) pad_.state.axes[1] = -1.0;  // the stick follows the deadman
    pad_.state.held[kB] = false;
  }
  void go(bool held) override {
    wants_ = held;
    pad_.state.held[kLb] = held;
    pad_.state.axes[1] = 0.0;
  }
  void press_stop() override { pad_.state.held[kB] = true; }
  void ask_stand(bool held) override { pad_.state.held[kRb] = pad_.state.held[kA] = held; }
  void ask_reset(bool held) override { pad_.state.held[kRb] = pad_.state.held[kX] = held; }
  void leave() override { there_ = false; }
  void come_back() override {
    there_ = true;
    ++pad_.id;
  }

 private:
  static constexpr std::size_t kA = 0, kB = 1, kX = 2, kLb = 9, kRb = 10;
  PadCommand command_{read_mapping(find_mapping("standard"))};
  PadReport pad_{.id = 1};
  Buttons before_;
  bool wants_ = false, there_ = true;
};

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
        Row{"gamepad", [](const io::Clock& clock) -> std::unique_ptr<Hand> { return std::make_unique<Pad>(clock); }}),
    [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace pmg::gamepad
