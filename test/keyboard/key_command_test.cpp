// The command of the pressed keys, and its end: keys released, lost, or left alone.
#include "keyboard/key_command.hpp"

#include <gtest/gtest.h>

#include <set>

#include "operator/hold_to_drive.hpp"

namespace pmg::ops {
namespace {

constexpr std::int64_t kMs = 1'000'000;
const CommandLimits kLimits{.lower = {-0.5, -0.35, -0.8, -0.15, -0.25, -0.2},
                            .upper = {0.8, 0.35, 0.8, 0.5, 0.25, 0.02}};

/// Keys, the rule of what is held, and a clock that only the test moves.
struct Keyboard {
  explicit Keyboard(KeyReport report) : keys(report) { keys.set_limits(kLimits); }
  void press(Key key, bool fast = false) { keys.press(key, fast, now_ns); }
  void wait(std::int64_t ms) {
    for (; ms > 0; ms -= 10) {
      now_ns += 10 * kMs;
      keys.listen(now_ns);
      command();
    }
  }
  Command command() {
    const bool armed = rule.armed().has_value();
    rule.step(keys.holds(now_ns), now_ns);
    if (armed && !rule.armed()) keys.rest();
    Command command = keys.command(rule.armed(), now_ns);
    if (!rule.armed()) command[kVx] = command[kVy] = command[kOmega] = 0.0;
    return command;
  }
  void hold(Key key, std::int64_t ms) {
    for (; ms > 0; ms -= 30) {
      wait(30);
      keys.repeat(key, false, now_ns);
    }
  }
  double operator[](Channel channel) { return command()[channel]; }

  std::int64_t now_ns = 1'000'000'000'000;
  KeyCommand keys;
  HoldToDrive rule;
};

struct Window : Keyboard {
  Window() : Keyboard(KeyReport::kPressAndRelease) { keys.listen(now_ns); }
};
struct Terminal : Keyboard {
  Terminal() : Keyboard(KeyReport::kPressOnly) {}
};

TEST(KeyCommand, EveryNameIsAKeyAndEveryKeyHasAName) {
  std::set<Key> named;
  for (const char* name : {"w", "up", "s", "down", "a", "left",  "d",      "right",     "q",     "e", "k", "i",
                           "o", "u",  "j", "l",    "n", "space", "escape", "backspace", "enter", "r", "h", "g"}) {
    ASSERT_TRUE(key_named(name)) << name;
    named.insert(*key_named(name));
  }
  EXPECT_EQ(named.size(), kKeys);
  EXPECT_FALSE(key_named(""));
  EXPECT_FALSE(key_named("f"));
}

TEST(KeyCommand, InAWindowAHeldKeyAsksForHalfTheRangeAndWithShiftForAllOfIt) {
  Window window;
  window.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4);
  window.press(Key::kBackwards);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4 - 0.25) << "each direction has its own range";
  window.keys.release(Key::kForwards, window.now_ns);
  EXPECT_DOUBLE_EQ(window[kVx], -0.25);
  window.press(Key::kTurnRight, true);
  EXPECT_DOUBLE_EQ(window[kOmega], -0.8);
}

TEST(KeyCommand, InAWindowAKeyThatIsLetGoAsksForNothing) {
  Window window;
  window.press(Key::kForwards);
  window.press(Key::kTurnLeft);
  window.keys.release(Key::kForwards, window.now_ns);
  EXPECT_EQ(window[kVx], 0.0);
  EXPECT_DOUBLE_EQ(window[kOmega], 0.4) << "the other one is still held";
  window.keys.release(Key::kTurnLeft, window.now_ns);
  EXPECT_EQ(window[kOmega], 0.0);
}

TEST(KeyCommand, AWindowThatLosesTheKeyboardHoldsNoKey) {
  Window window;
  window.press(Key::kForwards);
  window.press(Key::kStepLeft);
  window.keys.release_all();
  EXPECT_EQ(window[kVx], 0.0);
  EXPECT_EQ(window[kVy], 0.0);
  window.keys.repeat(Key::kForwards, false, window.now_ns);
  EXPECT_EQ(window[kVx], 0.0) << "a repetition is no press";
}

TEST(KeyCommand, AWindowThatStandsStillHoldsNoKey) {
  Window window;
  window.press(Key::kForwards);
  window.now_ns += HoldToDrive::kDeaf_ns + kMs;
  EXPECT_EQ(window[kVx], 0.0);
  window.keys.listen(window.now_ns);
  EXPECT_EQ(window[kVx], 0.0) << "when it is back, the key must be pressed anew";
}

TEST(KeyCommand, APressThatAWindowFindsWhenItPollsForTheFirstTimeInALongWhileCounts) {
  Window window;
  for (int k = 0; k < 40; ++k) {  // the program goes on, the window doesn't
    window.now_ns += 10 * kMs;
    window.command();
  }
  window.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4) << "before the poll has returned";
  window.now_ns += HoldToDrive::kDeaf_ns + kMs;
  EXPECT_EQ(window[kVx], 0.0) << "it polls no more";
}

TEST(KeyCommand, ALostReleaseIsNoticedWhenTheKeyNoLongerRepeats) {
  Window window;
  window.press(Key::kForwards);
  window.hold(Key::kForwards, 1500);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4);
  window.wait(KeyCommand::kRepeatLost_ns / kMs - 20);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4) << "a busy computer";
  window.wait(40);
  EXPECT_EQ(window[kVx], 0.0);
}

TEST(KeyCommand, AKeyThatAnotherOneKeepsFromRepeatingIsStillHeldForAWhile) {
  Window window;
  window.press(Key::kForwards);
  window.hold(Key::kForwards, 900);
  window.press(Key::kTurnLeft);  // from now on keyboards repeat only this one
  window.hold(Key::kTurnLeft, 30'000);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4) << "in a circle for as long as one likes";
  window.keys.release(Key::kTurnLeft, window.now_ns);
  window.wait(KeyCommand::kUnconfirmed_ns / kMs - 20);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4);
  window.wait(40);
  EXPECT_EQ(window[kVx], 0.0) << "nothing shows any more that somebody holds it";
}

TEST(KeyCommand, AKeyWithoutMeaningKeepsOthersFromRepeatingToo) {
  Window window;
  window.press(Key::kForwards);
  window.hold(Key::kForwards, 900);
  window.keys.press_other();
  window.wait(2000);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4);
}

TEST(KeyCommand, SpaceBringsVelocityToZeroAndHeldKeysMustBePressedAnew) {
  Window window;
  window.press(Key::kForwards);
  window.press(Key::kRest);
  EXPECT_EQ(window[kVx], 0.0);
  window.keys.repeat(Key::kForwards, false, window.now_ns);
  EXPECT_EQ(window[kVx], 0.0);
  window.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(window[kVx], 0.4);
}

TEST(KeyCommand, InATerminalEachPressIsAStepUpToHalfTheRangeAndWithShiftToAllOfIt) {
  Terminal terminal;
  terminal.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.1);
  for (int k = 0; k < 9; ++k) terminal.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.4);
  terminal.press(Key::kForwards, true);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.5);
  for (int k = 0; k < 9; ++k) terminal.press(Key::kForwards, true);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.8);
  terminal.press(Key::kForwards);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.8) << "a slow press doesn't jump";
  for (int k = 0; k < 8; ++k) terminal.press(Key::kBackwards);
  EXPECT_NEAR(terminal[kVx], 0.0, 1e-12) << "as many steps back";
  for (int k = 0; k < 9; ++k) terminal.press(Key::kBackwards);
  EXPECT_DOUBLE_EQ(terminal[kVx], -0.25);
}

TEST(KeyCommand, InATerminalASecondWithoutAnyKeyBringsVelocityToZero) {
  Terminal terminal;
  terminal.press(Key::kForwards);
  terminal.wait(980);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.1);
  terminal.press(Key::kSquat);
  terminal.wait(980);
  EXPECT_DOUBLE_EQ(terminal[kVx], 0.1) << "any key is one";
  terminal.wait(20);
  EXPECT_EQ(terminal[kVx], 0.0);
  EXPECT_DOUBLE_EQ(terminal[kHeight], -0.02) << "postures stay";
}

TEST(KeyCommand, PosturesStayInBothUntilUpright) {
  for (const KeyReport report : {KeyReport::kPressAndRelease, KeyReport::kPressOnly}) {
    Keyboard keyboard(report);
    keyboard.keys.listen(keyboard.now_ns);
    for (int k = 0; k < 3; ++k) keyboard.press(Key::kSquat);
    keyboard.press(Key::kBendForwards);
    keyboard.press(Key::kLeanRight);
    for (const Key key : {Key::kSquat, Key::kBendForwards, Key::kLeanRight})
      keyboard.keys.release(key, keyboard.now_ns);
    keyboard.wait(10'000);
    EXPECT_NEAR(keyboard[kHeight], -0.06, 1e-12);
    EXPECT_NEAR(keyboard[kPitch], 0.05, 1e-12);
    EXPECT_NEAR(keyboard[kRoll], 0.05, 1e-12);
    keyboard.press(Key::kUpright);
    for (const Channel channel : {kHeight, kPitch, kRoll}) EXPECT_EQ(keyboard[channel], 0.0);
  }
}

TEST(KeyCommand, PosturesEndWhereTheRobotsRangesDo) {
  Terminal terminal;
  for (int k = 0; k < 30; ++k) terminal.press(Key::kRise);
  EXPECT_DOUBLE_EQ(terminal[kHeight], 0.02);
  for (int k = 0; k < 30; ++k) terminal.press(Key::kBendBack);
  EXPECT_DOUBLE_EQ(terminal[kPitch], -0.15);
  for (int k = 0; k < 3; ++k) terminal.press(Key::kBendForwards);
  EXPECT_NEAR(terminal[kPitch], 0.0, 1e-12);
}

TEST(KeyCommand, BeforeTheRangesAreKnownNothingIsAskedFor) {
  KeyCommand keys(KeyReport::kPressOnly);
  for (std::size_t k = 0; k < kKeys; ++k) keys.press(static_cast<Key>(k), true, 1);
  EXPECT_EQ(keys.command(0, 1), Command{});
}

}  // namespace
}  // namespace pmg::ops
