// A robot driven by keys over the network: from limp to walking and to rest, and the things that must never happen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "keyboard/key_command.hpp"
#include "operator/drive.hpp"
#include "operator/driving_station.hpp"
#include "operator/networked_robot.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {
namespace {

using control::Mode;
using hal::CraneState;
using testing::HasSubstr;

constexpr double kStep_s = 0.01;

/// Keys and the machine that they drive by.
struct DrivenKeyboard {
  DrivenKeyboard(OperatorSource& source, KeyReport report)
      : clock(source.clock()), keys(report), driver(source, "biped", keys) {}
  void press(Key key, bool fast) {
    keys.press(key, fast, clock.now_ns());
    driver.heed();
  }
  void repeat(Key key, bool fast) { keys.repeat(key, fast, clock.now_ns()); }
  void release(Key key) { keys.release(key, clock.now_ns()); }
  void release_all() { keys.release_all(); }
  void step() {
    keys.listen(clock.now_ns());
    driver.step();
  }
  void set_limits(const CommandLimits& limits) { driver.set_limits(limits); }
  void let_go() { driver.let_go(); }
  bool gone() const { return driver.gone(); }
  std::string text() const { return driver.text(); }

  const io::Clock& clock;
  KeyCommand keys;
  RobotDriver driver;
};

class KeyboardTest : public testing::Test {
 protected:
  explicit KeyboardTest(KeyReport report = KeyReport::kPressAndRelease) : driver_(mine_, report) {
    network_.link.subscribe("MODE", [this](io::Bytes bytes) {
      const auto request = seal::decode_sealed<pmg_msgs::mode_t, pmg_msgs::seal_t>(bytes);
      if (request) requests_.push_back(request->message);
    });
    driver_.set_limits(robot_.robot.command_limits);
    run(0.5);
  }
  void step() {
    network_.advance();
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= kStep_s) step();
  }
  /// Seconds until the condition holds; more than at_most_s: it never held.
  template <typename Condition>
  double until(Condition condition, double at_most_s = 10.0) {
    double elapsed_s = 0.0;
    while (!condition() && elapsed_s <= at_most_s) {
      step();
      elapsed_s += kStep_s;
    }
    return elapsed_s;
  }
  Mode mode() const { return robot_.result().mode; }
  double vx() const { return robot_.result().reference.command[kVx]; }
  void walk() {
    driver_.press(Key::kForwards, false);
    EXPECT_LT(until([&] { return mode() == Mode::kWalk && vx() > 0.1; }), 10.0) << driver_.text();
  }
  void stop_by_other() {
    const ModeWish stop(other_, "biped", Goal::kStop, 2.0);
    run(0.2);
    ASSERT_EQ(mode(), Mode::kDamping);
  }
  void expect_never_up(double seconds) {
    for (; seconds > 0.0; seconds -= kStep_s) {
      step();
      ASSERT_LE(mode(), Mode::kDamping) << driver_.text();
    }
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  OperatorSource mine_{network_.link, "keyboard.1", 1, network_.clock};
  OperatorSource other_{network_.link, "pmg_send.2", 1, network_.clock};
  DrivenKeyboard driver_;
  std::vector<pmg_msgs::mode_t> requests_;
};

class TerminalKeyboardTest : public KeyboardTest {
 protected:
  TerminalKeyboardTest() : KeyboardTest(KeyReport::kPressOnly) {}
};

TEST_F(KeyboardTest, OneHeldKeyTakesALimpRobotToWalking) {
  EXPECT_EQ(mode(), Mode::kPassive);
  EXPECT_THAT(driver_.text(), HasSubstr("makes it stand up"));
  walk();
  EXPECT_EQ(robot_.result().driving, control::Source::make("keyboard.1", 1));
}

TEST_F(KeyboardTest, AKeyPressedBeforeTheRobotsLimitsAreKnownTakesEffectThenIfItIsStillHeld) {
  for (const bool held : {false, true}) {
    DrivenKeyboard early(other_, KeyReport::kPressAndRelease);
    const auto run_early = [&](double seconds) {
      for (; seconds > 1e-9; seconds -= kStep_s) {
        step();
        early.step();
      }
    };
    early.press(Key::kForwards, false);
    run_early(0.5);
    EXPECT_EQ(mode(), Mode::kPassive) << "nobody knows how fast it may walk";
    if (!held) early.release(Key::kForwards);
    early.set_limits(robot_.robot.command_limits);
    run_early(6.0);
    EXPECT_EQ(mode(), held ? Mode::kWalk : Mode::kPassive) << early.text();
  }
}

TEST_F(KeyboardTest, AKeyThatIsLetGoBringsVelocityToZeroWithinHalfASecondThenStandAndNeverDamps) {
  for (const bool loses_keyboard : {false, true}) {
    walk();
    run(1.0);
    if (loses_keyboard) {
      driver_.release_all();
    } else {
      driver_.release(Key::kForwards);
    }
    const double zero_s = until([&] { return vx() == 0.0; });
    EXPECT_LE(zero_s, 0.48) << "0.5 s, of which a screen that draws 50 times a second may take 0.02 s";
    EXPECT_LE(zero_s + until([&] { return mode() == Mode::kStand; }), 1.0);
    run(2.0);
    EXPECT_EQ(mode(), Mode::kStand);
    EXPECT_EQ(robot_.result().driving, control::Source{}) << "an idle keyboard is in nobody's way";
  }
  for (const auto& request : requests_) EXPECT_GE(request.mode, pmg_msgs::mode_t::STAND);
}

TEST_F(KeyboardTest, PressedAgainWhileItComesToRestItGoesOn) {
  walk();
  for (int k = 0; k < 5; ++k) {
    driver_.release(Key::kForwards);
    run(0.13 * (k + 1));
    driver_.press(Key::kForwards, false);
    run(0.3);
    EXPECT_LT(until([&] { return mode() == Mode::kWalk && vx() > 0.1; }), 2.0);
  }
}

TEST_F(KeyboardTest, APostureIsHeldWithoutAnyKeyAndGivenUpByOne) {
  driver_.press(Key::kSquat, false);
  driver_.release(Key::kSquat);
  EXPECT_LT(until([&] { return robot_.result().reference.command[kHeight] < -0.019; }), 10.0);
  run(5.0);
  EXPECT_EQ(mode(), Mode::kWalk) << "postures are of Walk";
  driver_.press(Key::kUpright, false);
  EXPECT_LT(until([&] { return mode() == Mode::kStand; }), 3.0);
}

TEST_F(KeyboardTest, EscapeDampsAtOnceInEveryState) {
  for (const double after_s : {0.0, 0.05, 0.4, 3.0}) {
    driver_.press(Key::kStand, false);
    run(2.0);
    driver_.press(Key::kForwards, false);
    run(after_s);
    driver_.press(Key::kDamp, false);
    EXPECT_LE(until([&] { return mode() == Mode::kDamping; }), 0.02) << "a tick, and the way";
    driver_.release(Key::kForwards);
    run(1.0);
    EXPECT_EQ(mode(), Mode::kDamping);
  }
}

TEST_F(KeyboardTest, AfterAStopKeysThatMoveDoNothingUntilItIsToldToStand) {
  walk();
  stop_by_other();
  for (int k = 0; k < 5; ++k) {
    driver_.repeat(Key::kForwards, false);
    expect_never_up(0.1);
    driver_.press(Key::kForwards, false);
    expect_never_up(0.2);
  }
  EXPECT_THAT(driver_.text(), HasSubstr("somebody stopped it"));
  EXPECT_THAT(driver_.text(), HasSubstr("Enter"));
  driver_.press(Key::kStand, false);
  EXPECT_LT(until([&] { return mode() == Mode::kStand; }), 5.0);
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "the keys pressed before are forgotten";
}

TEST_F(KeyboardTest, AStopWhileItClimbsIsNotOverruled) {
  driver_.press(Key::kForwards, false);
  run(0.4);
  stop_by_other();
  expect_never_up(5.0);
}

TEST_F(KeyboardTest, ARobotThatWasFoundBrakingIsLeftSo) {
  const ModeWish stop(other_, "biped", Goal::kDamping, 2.0);
  for (int k = 0; k < 10; ++k) network_.advance();
  OperatorSource fresh(network_.link, "keyboard.3", 1, network_.clock);
  DrivenKeyboard newcomer(fresh, KeyReport::kPressAndRelease);
  newcomer.set_limits(robot_.robot.command_limits);
  for (int k = 0; k < 300; ++k) {
    network_.advance();
    if (k == 50) newcomer.press(Key::kForwards, false);
    newcomer.step();
    ASSERT_EQ(mode(), Mode::kDamping) << newcomer.text();
  }
}

TEST_F(KeyboardTest, AFaultIsSaidAndResetByItsKeyAlone) {
  walk();
  robot_.policy->how = test::BreakablePolicy::Break::kNotANumber;
  run(0.1);
  ASSERT_EQ(mode(), Mode::kFault);
  EXPECT_THAT(driver_.text(), HasSubstr("fault: "));
  robot_.policy->how = test::BreakablePolicy::Break::kNone;
  driver_.press(Key::kStand, false);
  run(1.0);
  EXPECT_EQ(mode(), Mode::kFault);
  driver_.press(Key::kReset, false);
  run(0.3);
  EXPECT_EQ(mode(), Mode::kDamping);
  driver_.press(Key::kForwards, false);
  expect_never_up(0.5);
  driver_.press(Key::kStand, false);
  EXPECT_LT(until([&] { return mode() == Mode::kStand; }), 5.0);
}

TEST_F(KeyboardTest, WhileAnotherDrivesItWaitsAndSaysSo) {
  Drive drive(other_, "biped", Command{{0.3}}, {.duration_s = 100.0, .climb = true});
  while (!drive.driving()) {
    step();
    drive.step();
  }
  driver_.press(Key::kForwards, false);
  for (int k = 0; k < 200; ++k) {
    step();
    drive.step();
  }
  EXPECT_THAT(driver_.text(), HasSubstr("another source drives: pmg_send.2"));
  EXPECT_EQ(robot_.result().driving, control::Source::make("pmg_send.2", 1));
}

TEST_F(KeyboardTest, AControllerThatFallsSilentIsSaidAndNotFollowed) {
  walk();
  network_.control_alive = false;
  run(1.0);
  EXPECT_THAT(driver_.text(), HasSubstr("no longer heard"));
  network_.control_alive = true;
  run(3.0);
  EXPECT_NE(mode(), Mode::kWalk) << "the key must be pressed anew";
}

TEST_F(KeyboardTest, LettingGoBringsItToRestAndFreesItForOthers) {
  walk();
  driver_.let_go();
  driver_.press(Key::kForwards, false);
  EXPECT_LT(until([&] { return driver_.gone(); }), 2.0);
  EXPECT_EQ(mode(), Mode::kStand);
  run(0.05);  // a little more than the last command's lease
  EXPECT_EQ(robot_.result().driving, control::Source{});
}

TEST_F(KeyboardTest, OnAHoistItStandsIsSetDownAndOnlyThenWalks) {
  hal::HoistLine hoist;
  robot_.comms.work(&hoist);
  run(0.3);
  driver_.press(Key::kForwards, false);
  until([&] { return mode() == Mode::kStand; });
  run(3.0);
  EXPECT_EQ(mode(), Mode::kStand) << "not in the air";
  EXPECT_TRUE(hoist.stands()) << "the ramp is over";
  hoist.show(CraneState::kLowering);
  run(0.3);
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_THAT(driver_.text(), HasSubstr("sets the robot down"));
  hoist.show(CraneState::kFree);
  EXPECT_LT(until([&] { return mode() == Mode::kWalk; }), 0.5);
}

TEST_F(KeyboardTest, ALiftedRobotStaysUpUntilItIsSetDownOrStandsUpAnew) {
  hal::HoistLine hoist;
  hoist.show(CraneState::kFree);
  robot_.comms.work(&hoist);
  walk();
  driver_.press(Key::kLift, false);
  until([&] { return hoist.stays_up(); }, 1.0);
  ASSERT_TRUE(hoist.stays_up());
  EXPECT_LT(until([&] { return vx() == 0.0; }), 0.6) << "it doesn't walk in the air";
  hoist.show(CraneState::kHolding);
  run(2.0);
  driver_.press(Key::kForwards, false);
  run(1.5);
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_THAT(driver_.text(), HasSubstr("until it is set down"));
  driver_.press(Key::kDamp, false);
  run(0.5);
  EXPECT_TRUE(hoist.stays_up());
  driver_.press(Key::kStand, false);
  run(1.0);
  EXPECT_FALSE(hoist.stays_up());
}

TEST_F(TerminalKeyboardTest, PressesWalkAndASecondWithoutOneStops) {
  driver_.press(Key::kForwards, false);
  until([&] { return mode() == Mode::kWalk; });
  for (int k = 0; k < 10; ++k) {
    driver_.press(Key::kForwards, false);
    run(0.2);
  }
  EXPECT_NEAR(vx(), 0.2, 1e-9) << "half of the range";
  run(0.8 + 0.5 + 0.05);
  EXPECT_EQ(vx(), 0.0) << "a second after the last press at most, and the ramp";
  EXPECT_EQ(mode(), Mode::kWalk) << "ready for the next press";
}

TEST_F(TerminalKeyboardTest, AHeldKeyThatRepeatsLikePressesDoesNotRaiseAStoppedRobot) {
  driver_.press(Key::kForwards, false);
  until([&] { return mode() == Mode::kWalk; });
  stop_by_other();
  for (int k = 0; k < 100; ++k) {
    driver_.press(Key::kForwards, false);
    expect_never_up(0.03);
  }
}

TEST_F(TerminalKeyboardTest, ANewControllerOfTheSameNameIsNotRaisedByAKeyThatRepeats) {
  driver_.press(Key::kForwards, false);
  until([&] { return mode() == Mode::kWalk; });
  network_.control_alive = false;
  for (int k = 0; k < 31; ++k) network_.advance();  // a start takes longer
  pmg_msgs::status_t status{};
  status.robot = "biped";
  status.session = 99;  // limp, as after its start
  network_.link.publish("STATUS", status);
  network_.link.receive(0);
  driver_.press(Key::kForwards, false);
  driver_.step();
  EXPECT_THAT(driver_.text(), HasSubstr("started anew"));
}

TEST(DrivingStation, WithoutAControllerThatIsSaidAndEscapeStopsWhoeverComes) {
  test::Network network;
  KeyCommand keys(KeyReport::kPressOnly);
  DrivingStation station(network.link, keys, "", 1, network.clock);
  station.step(0);
  EXPECT_THAT(station.lines().front(), HasSubstr("no controller is heard on memq://"));
  test::NetworkedRobot& robot = network.add_robot("biped");
  OperatorSource other(network.link, "other", 1, network.clock);
  for (int k = 0; k < 5; ++k) network.advance();
  ModeWish stand(other, "biped", Goal::kStand, 5.0);
  ASSERT_EQ(network.finish(stand), Progress::kReached);
  keys.press("escape", false, network.clock.now_ns());
  station.step(0);
  for (int k = 0; k < 3; ++k) network.advance();
  EXPECT_EQ(robot.result().mode, Mode::kDamping);
}

TEST(DrivingStation, OfSeveralRobotsItDrivesNoneThatIsNotNamed) {
  test::Network network;
  network.add_robot("first");
  network.add_robot("second");
  KeyCommand keys(KeyReport::kPressOnly);
  DrivingStation station(network.link, keys, "", 1, network.clock);
  for (int k = 0; k < 50; ++k) {
    network.advance();
    station.step(0);
  }
  EXPECT_THAT(station.lines().front(), HasSubstr("several robots are heard (first, second)"));
}

}  // namespace
}  // namespace pmg::ops
