#include "operator/keyboard_driver.hpp"

#include <utility>

namespace pmg::ops {

namespace {

DriverManner by_keys() {
  return {.command_raises = true,
          .at_once = true,
          .raises = "Enter makes it stand up",
          .resets = "R resets it",
          .drives = "a key drives it",
          .starts = "a key makes it stand up and walk",
          .anew = "Press a key anew"};
}

}  // namespace

KeyboardDriver::KeyboardDriver(OperatorSource& source, std::string robot, KeyReport report)
    : clock_(source.clock()), keys_(report), driver_(source, std::move(robot), keys_, by_keys()) {}

void KeyboardDriver::press(Key key, bool fast) {
  if (driver_.letting_go() && key != Key::kDamp) return;
  keys_.press(key, fast, clock_.now_ns());
  switch (key) {
    case Key::kDamp:
      return driver_.stop();
    case Key::kStand:
      return driver_.stand();
    case Key::kReset:
      return driver_.reset();
    case Key::kLift:
    case Key::kSetDown:
      return driver_.hoist(key == Key::kLift);
    default:
      return;
  }
}

}  // namespace pmg::ops
