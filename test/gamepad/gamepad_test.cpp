// A robot driven by SDL's virtual game controllers over a network with a virtual clock.
#include <SDL.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gamepad/pad_text.hpp"
#include "gamepad/sdl_pads.hpp"
#include "gamepad/virtual_pad.hpp"
#include "operator/networked_robot.hpp"

namespace pmg::gamepad {
namespace {

using control::Mode;

constexpr int kB = SDL_CONTROLLER_BUTTON_B, kA = SDL_CONTROLLER_BUTTON_A, kLb = SDL_CONTROLLER_BUTTON_LEFTSHOULDER,
              kRb = SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, kY = SDL_CONTROLLER_AXIS_LEFTY;

class GamepadTest : public testing::Test {
 protected:
  GamepadTest() {
    nlohmann::json options;
    const CommandLimits& limits = robot_.robot.command_limits;
    for (std::size_t i = 0; i < kChannels; ++i) {
      options["command"]["lower"][kChannelNames[i]] = limits.lower[i];
      options["command"]["upper"][kChannelNames[i]] = limits.upper[i];
    }
    robot_.run.options = options.dump();  // as control::control_json writes it; without it no command is known to fit
    run(1.5);                             // the controller tells them each second
  }
  void step() {
    network_.advance();
    command_.take(pads_.poll(), network_.clock.now_ns());
    station_.step(0);
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  void stand(VirtualPad& pad) {
    pad.button(kRb, true);
    pad.button(kA, true);
    run(6.0);
    pad.button(kRb, false);
    pad.button(kA, false);
    run(0.1);
    ASSERT_EQ(mode(), Mode::kStand);
  }
  void walk(VirtualPad& pad) {
    pad.button(kLb, true);
    run(0.05);
    pad.axis(kY, -1.0);
    run(2.0);
    ASSERT_EQ(mode(), Mode::kWalk);
    ASSERT_GT(vx(), 0.0);
  }
  Mode mode() const { return robot_.result().mode; }
  double vx() const { return robot_.result().reference.command[kVx]; }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  SdlPads pads_;
  PadCommand command_{read_mapping(find_mapping("standard"))};
  ops::DrivingStation station_{network_.link, command_, "biped", 1, network_.clock};
};

TEST_F(GamepadTest, StandsByItsChordWalksToTheEndOfTheRangeAndStandsWhenTheDeadmanIsLetGo) {
  VirtualPad pad;
  run(0.1);
  pad.button(kLb, true);
  pad.axis(kY, -1.0);
  run(2.0);
  EXPECT_EQ(mode(), Mode::kPassive) << "a stick raises no robot";
  pad.button(kLb, false);
  pad.axis(kY, 0.0);
  run(0.1);
  stand(pad);
  walk(pad);
  EXPECT_DOUBLE_EQ(vx(), robot_.robot.command_limits.upper[kVx]);
  pad.button(kLb, false);
  run(0.55);
  EXPECT_EQ(vx(), 0.0);
  run(1.5);
  EXPECT_EQ(mode(), Mode::kStand);
}

TEST_F(GamepadTest, AnUnpluggedPadStopsAndAReplugedOneNeedsAFreshPressWithNeutralSticks) {
  VirtualPad pad;
  run(0.1);
  stand(pad);
  walk(pad);
  pad.unplug();
  run(0.55);
  EXPECT_EQ(vx(), 0.0);
  run(1.5);
  EXPECT_EQ(mode(), Mode::kStand);
  VirtualPad again;
  again.button(kLb, true);
  run(0.2);
  again.axis(kY, -1.0);
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "the deadman was down when it came";
  again.button(kLb, false);
  run(0.1);
  again.button(kLb, true);
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand) << "the stick is stuck";
  again.axis(kY, 0.0);
  again.button(kLb, false);
  run(0.1);
  walk(again);
}

TEST_F(GamepadTest, APadThatSendsNothingForThreeSecondsIsTakenForLost) {
  VirtualPad pad;
  run(0.1);
  stand(pad);
  walk(pad);
  run(1.0 + 0.55 + 0.1);
  EXPECT_EQ(vx(), 0.0);
}

TEST_F(GamepadTest, APadWithoutTheStopButtonNeitherDrivesNorStopsAndSaysSo) {
  VirtualPad pad(SDL_JOYSTICK_TYPE_GAMECONTROLLER, 1);  // a alone
  run(0.1);
  const auto& pads = pads_.poll();
  ASSERT_EQ(pads.size(), 1U);
  EXPECT_THAT(pad_lines(command_, station_, pads, {}),
              testing::ElementsAre(testing::HasSubstr(": NEITHER DRIVES NOR STOPS: it has no button b, the stop")));
}

TEST_F(GamepadTest, APadsLinesSayWhetherItDrivesAndWhyNot) {
  using testing::ElementsAre, testing::EndsWith;
  EXPECT_THAT(pad_lines(command_, station_, {}, {}),
              ElementsAre(testing::StartsWith("no game controller: plug one in")));
  VirtualPad pad;
  run(0.1);
  const auto lines = [&] { return pad_lines(command_, station_, pads_.poll(), {}); };
  EXPECT_THAT(lines(), ElementsAre(EndsWith(": stops, and drives when its deadman is held")));
  pad.axis(kY, -1.0);
  pad.button(kLb, true);
  run(0.1);
  EXPECT_THAT(lines(), ElementsAre(EndsWith(": stops, and drives when its deadman is held"), "  a stick isn't neutral",
                                   "  let go of leftshoulder and press it with neutral sticks"));
  pad.axis(kY, 0.0);
  pad.button(kLb, false);
  run(0.1);
  pad.button(kLb, true);
  run(0.1);
  EXPECT_THAT(lines(), ElementsAre(EndsWith(": drives")));
  EXPECT_THAT(pad_lines(command_, station_, {},
                        std::vector<UselessPad>{{.name = "Foo", .guid = "03", .why = "w", .remedy = "r"}}),
              ElementsAre("Foo: NEITHER DRIVES NOR STOPS: w", "  GUID 03", "  r"));
}

TEST_F(GamepadTest, OnePadDrivesAndAnyPadStopsWithinFiftyMilliseconds) {
  VirtualPad pad, other;
  run(0.1);
  stand(pad);
  walk(pad);
  other.button(kLb, true);
  run(0.1);
  pad.button(kLb, false);
  other.axis(kY, -1.0);
  run(0.55);
  EXPECT_EQ(vx(), 0.0) << "the other's deadman was pressed while this one drove";
  pad.axis(kY, 0.0);
  run(2.0);
  walk(pad);
  ops::OperatorSource flood(network_.link, "flood", 1, network_.clock);
  other.button(kB, true);
  command_.take(pads_.poll(), network_.clock.now_ns());
  other.button(kB, false);
  for (int k = 0; k < 5 && mode() != Mode::kDamping; ++k) {
    for (int m = 0; m < 300; ++m) flood.send_command("biped", Command{}, 1.0);
    step();
  }
  EXPECT_EQ(mode(), Mode::kDamping);
  run(2.0);
  EXPECT_EQ(mode(), Mode::kDamping);
}

TEST_F(GamepadTest, AfterAPauseOfTheProgramItDoesNotDriveOn) {
  VirtualPad pad;
  run(0.1);
  stand(pad);
  walk(pad);
  for (int k = 0; k < 40; ++k) network_.advance();
  run(2.5);
  EXPECT_EQ(mode(), Mode::kStand);
}

}  // namespace
}  // namespace pmg::gamepad
