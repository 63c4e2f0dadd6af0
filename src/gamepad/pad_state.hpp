// What a game controller's buttons and sticks are at one moment, independent of the library that reads them.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>

namespace pmg::gamepad {

/// SDL's names and order: a is the lower one of the four buttons, b the right one, whatever is printed on them.
inline constexpr std::array<const char*, 15> kButtonNames = {"a",
                                                             "b",
                                                             "x",
                                                             "y",
                                                             "back",
                                                             "guide",
                                                             "start",
                                                             "leftstick",
                                                             "rightstick",
                                                             "leftshoulder",
                                                             "rightshoulder",
                                                             "dpup",
                                                             "dpdown",
                                                             "dpleft",
                                                             "dpright"};
/// Stick axes from -1 (left, up) to 1 (right, down), then triggers from 0 to 1.
inline constexpr std::array<const char*, 6> kAxisNames = {"leftx",  "lefty",       "rightx",
                                                          "righty", "lefttrigger", "righttrigger"};
inline constexpr std::size_t kButtons = kButtonNames.size(), kAxes = kAxisNames.size(), kStickAxes = 4;

using Buttons = std::bitset<kButtons>;

struct PadState {
  std::array<double, kAxes> axes{};
  Buttons held{};
  Buttons pressed{};     ///< since the last state, also if they were let go since
  bool changed = false;  ///< the pad has sent anything since the last state
};

struct PadReport {
  std::int32_t id = 0;  ///< another one at each connection
  std::string name{};
  PadState state{};
  Buttons missing{};  ///< SDL's mapping of this pad doesn't have them
  bool gone = false;  ///< it was unplugged; this is its last state
};

/// A plugged-in device that can neither drive nor stop. guid: SDL's name of this kind of device.
struct UselessPad {
  std::string name{}, guid{}, why{}, remedy{};
};

}  // namespace pmg::gamepad
