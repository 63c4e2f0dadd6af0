// What the buttons and sticks of a game controller mean: config/gamepads/*.yaml.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "gamepad/pad_state.hpp"
#include "operator/stick_shape.hpp"
#include "pmg/command.hpp"

namespace pmg::gamepad {

using ops::StickShape;

struct ChannelMap {
  std::size_t axis = 0;    ///< of a stick
  double sign = 1.0;       ///< -1: inverted
  double full_in_s = 1.0;  ///< velocity: shortest time from zero to the range's end; posture: time with a full stick
};

enum class Action { kStand, kReset, kLimp, kLift, kSetDown };
inline constexpr std::array<const char*, 5> kActionNames = {"stand", "reset", "limp", "lift", "set_down"};

/// A risky move: all of its buttons and no others, held for a time.
struct Chord {
  Action action = Action::kStand;
  Buttons buttons{};
  double hold_s = 0.0;
};

struct Mapping {
  std::size_t stop = 0, deadman = 0, posture = 0, upright = 0;  ///< buttons; posture: its sticks bend while it is held
  double still_s = 0.0;                ///< a pad whose sticks are out and that sends nothing for so long is lost
  std::array<StickShape, 2> sticks{};  ///< left, right
  std::array<ChannelMap, kChannels> channels{};  ///< the first three always; the others while `posture` is held
  std::vector<Chord> chords{};
};

/// The file of a mapping: a name ("standard", in config/gamepads) or a file, as files::config_file finds it.
/// Throws files::ConfigError for an unknown name.
std::filesystem::path find_mapping(const std::string& name);

/// Throws files::ConfigError with file, line and column.
Mapping read_mapping(const std::filesystem::path& file);

/// The table of what does what, for the terminal and docs/how-to/operation.md.
std::vector<std::array<std::string, 2>> mapping_rows(const Mapping& mapping);

}  // namespace pmg::gamepad
