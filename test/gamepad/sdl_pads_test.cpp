// What SDL's events make of pads, and of devices that are none.
#include "gamepad/sdl_pads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gamepad/virtual_pad.hpp"

namespace pmg::gamepad {
namespace {

TEST(SdlPads, ADeviceWithoutAMappingIsToldWithItsGuidAsLongAsItIsPluggedIn) {
  SdlPads pads;
  EXPECT_THAT(pads.useless(), testing::IsEmpty());
  VirtualPad stick(SDL_JOYSTICK_TYPE_FLIGHT_STICK);
  EXPECT_THAT(pads.poll(), testing::IsEmpty());
  ASSERT_EQ(pads.useless().size(), 1U);
  const UselessPad told = pads.useless().front();
  EXPECT_THAT(told.name, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(told.guid, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(told.guid.size(), 32U);
  EXPECT_THAT(told.why, testing::HasSubstr("doesn't know its buttons"));
  EXPECT_THAT(told.remedy, testing::HasSubstr("SDL_GAMECONTROLLERCONFIG"));
  stick.unplug();
  pads.poll();
  EXPECT_THAT(pads.useless(), testing::IsEmpty());
}

TEST(SdlPads, AGameControllerIsNotToldToBeUselessAlsoIfItWasThereBefore) {
  SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);
  {
    VirtualPad pad;
    VirtualPad stick(SDL_JOYSTICK_TYPE_WHEEL);
    SdlPads pads;
    EXPECT_EQ(pads.poll().size(), 1U);
    EXPECT_EQ(pads.useless().size(), 1U);
  }
  SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

TEST(SdlPads, APressThatIsOverBeforeThePollIsSeen) {
  SdlPads pads;
  VirtualPad pad;
  pads.poll();
  pad.button(1, true);
  SDL_JoystickUpdate();
  pad.button(1, false);
  const PadState state = pads.poll().front().state;
  EXPECT_TRUE(state.pressed[1]);
  EXPECT_FALSE(state.held[1]);
  EXPECT_FALSE(pads.poll().front().state.pressed[1]) << "it is told once";
}

TEST(SdlPads, AReadingOfTheGyroscopeIsASignOfLife) {
  SdlPads pads;
  VirtualPad pad;
  pads.poll();
  EXPECT_FALSE(pads.poll().front().state.changed);
  SDL_Event event{};
  event.type = SDL_CONTROLLERSENSORUPDATE;
  event.csensor.which = pad.id();
  SDL_PushEvent(&event);
  EXPECT_TRUE(pads.poll().front().state.changed);
  EXPECT_FALSE(pads.poll().front().state.changed);
}

}  // namespace
}  // namespace pmg::gamepad
