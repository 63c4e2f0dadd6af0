#include "gamepad/mapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/config_error.hpp"
#include "files/config_folders.hpp"
#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"

namespace pmg::gamepad {
namespace fs = std::filesystem;

namespace {

using files::ConfigReader;

constexpr double kShortestHold_s = 0.5;  // longer than any press by mistake

template <std::size_t N>
std::size_t index_of(const ConfigReader& reader, const std::string& key, const std::string& name,
                     const std::array<const char*, N>& names, std::size_t count, const char* what) {
  const auto* end = names.begin() + count;
  const auto* found = std::find(names.begin(), end, name);
  if (found != end) return static_cast<std::size_t>(found - names.begin());
  reader.fail(key, fmt::format("no {} is named '{}'", what, name), files::expected_name(name, {names.begin(), end}));
}

std::size_t button(ConfigReader& reader, const std::string& key) {
  return index_of(reader, key, reader.required<std::string>(key), kButtonNames, kButtons, "button");
}

StickShape read_stick(ConfigReader reader) {
  StickShape shape;
  shape.dead_zone = reader.required<double>("dead_zone", files::in_range(0.05, 0.5));
  shape.full_at = reader.required<double>("full_at", files::in_range(0.7, 1.0));
  shape.expo = reader.required<double>("expo", files::in_range(0.0, 1.0));
  reader.finish();
  return shape;
}

ChannelMap read_channel(ConfigReader reader) {
  ChannelMap map;
  map.axis = index_of(reader, "axis", reader.required<std::string>("axis"), kAxisNames, kStickAxes, "stick's axis");
  map.sign = reader.optional<bool>("invert", false) ? -1.0 : 1.0;
  map.full_in_s = reader.required<double>("full_in_s", files::in_range(0.05, 10.0));
  reader.finish();
  return map;
}

Chord read_chord(ConfigReader reader, Action action, const Mapping& mapping) {
  Chord chord{.action = action};
  const auto names = reader.required<std::vector<std::string>>("buttons");
  for (const std::string& name : names)
    chord.buttons.set(index_of(reader, "buttons", name, kButtonNames, kButtons, "button"));
  if (names.size() < 2 || chord.buttons.count() != names.size())
    reader.fail("buttons", "a risky move on fewer than two different buttons", "two or more");
  if (chord.buttons[mapping.stop] || chord.buttons[mapping.deadman])
    reader.fail("buttons", "the stop or the deadman is one of them", "other buttons");
  for (const Chord& other : mapping.chords) {
    if (other.buttons == chord.buttons)
      reader.fail("buttons", "another move has the same buttons", "a chord of its own");
  }
  chord.hold_s = reader.required<double>("hold_s", files::in_range(kShortestHold_s, 5.0));
  reader.finish();
  return chord;
}

}  // namespace

std::filesystem::path find_mapping(const std::string& name) { return files::config_file("gamepads", "mapping", name); }

Mapping read_mapping(const std::filesystem::path& file) {
  ConfigReader reader = ConfigReader::from_file(file);
  Mapping mapping;
  mapping.stop = button(reader, "stop");
  Buttons used;
  used.set(mapping.stop);
  for (const auto& [key, place] : {std::pair{"deadman", &mapping.deadman}, std::pair{"posture_while", &mapping.posture},
                                   std::pair{"upright", &mapping.upright}}) {
    *place = button(reader, key);
    if (used[*place]) reader.fail(key, "this button has another meaning", "a button of its own");
    used.set(*place);
  }
  mapping.still_s = reader.required<double>("still_s", files::in_range(0.5, 10.0));
  ConfigReader sticks = reader.map("sticks");
  mapping.sticks = {read_stick(sticks.map("left")), read_stick(sticks.map("right"))};
  sticks.finish();
  ConfigReader channels = reader.map("channels");
  for (std::size_t i = 0; i < kChannels; ++i) {
    mapping.channels[i] = read_channel(channels.map(kChannelNames[i]));
    for (std::size_t k = i < kVelocityChannels ? 0 : kVelocityChannels; k < i; ++k) {
      if (mapping.channels[k].axis == mapping.channels[i].axis)
        channels.fail(kChannelNames[i], fmt::format("{} has this axis", kChannelNames[k]), "an axis of its own");
    }
  }
  channels.finish();
  ConfigReader chords = reader.map("chords");
  for (std::size_t i = 0; i < kActionNames.size(); ++i)
    mapping.chords.push_back(read_chord(chords.map(kActionNames[i]), static_cast<Action>(i), mapping));
  chords.finish();
  reader.finish();
  return mapping;
}

std::vector<std::array<std::string, 2>> mapping_rows(const Mapping& mapping) {
  constexpr std::array kWords = {"forwards, backwards", "step sideways", "turn", "bend", "lean", "squat, rise"};
  constexpr std::array kActs = {"stand, after a stop, too", "reset a fault", "limp: the drives give no torque",
                                "lift (simulated hoist)", "set down (simulated hoist)"};
  std::vector<std::array<std::string, 2>> rows = {
      {kButtonNames[mapping.stop], "DAMPS AT ONCE, on any pad, without the deadman"},
      {kButtonNames[mapping.deadman], "deadman: the robot moves only while it is held"}};
  for (std::size_t i = 0; i < kChannels; ++i) {
    const char* axis = kAxisNames[mapping.channels[i].axis];
    rows.push_back(
        {i < kVelocityChannels ? axis : fmt::format("{} + {}", kButtonNames[mapping.posture], axis), kWords[i]});
  }
  rows.push_back({kButtonNames[mapping.upright], "upright again"});
  for (const Chord& chord : mapping.chords) {
    std::string names;
    for (std::size_t b = 0; b < kButtons; ++b)
      if (chord.buttons[b]) names += (names.empty() ? "" : " + ") + std::string(kButtonNames[b]);
    rows.push_back(
        {fmt::format("{} for {:.1f} s", names, chord.hold_s), kActs[static_cast<std::size_t>(chord.action)]});
  }
  return rows;
}

}  // namespace pmg::gamepad
