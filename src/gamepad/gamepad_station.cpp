#include "gamepad/gamepad_station.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/plain_text.hpp"

namespace pmg::gamepad {

GamepadStation::GamepadStation(io::LcmLink& link, Mapping mapping, std::string robot, std::int64_t session,
                               const io::Clock& clock, const seal::OperatorSeal& seal)
    : DrivingStation(link, "gamepad", std::move(robot), session, clock, seal), pads_(std::move(mapping)) {
  begin();
}

ops::RobotDriver& GamepadStation::make_driver(const std::string& robot) {
  const auto rows = mapping_rows(pads_.mapping());
  const std::string deadman = kButtonNames[pads_.mapping().deadman];
  const std::size_t first = rows.size() - pads_.mapping().chords.size();
  const std::string raises = rows[first][0] + " makes it stand up", resets = rows[first + 1][0] + " resets it";
  return robot_driver_.emplace(source(), robot, pads_,
                               ops::DriverManner{.command_raises = false,
                                                 .at_once = false,
                                                 .raises = raises,
                                                 .resets = resets,
                                                 .drives = deadman + " and a stick drive it",
                                                 .starts = raises,
                                                 .anew = "Press " + deadman + " anew, with neutral sticks"});
}

void GamepadStation::take(std::span<const PadReport> pads) {
  usable_.assign(pads.begin(), pads.end());
  std::erase_if(usable_, [&](const PadReport& pad) { return pad.missing[pads_.mapping().stop]; });
  pads_.take(usable_, clock().now_ns());
  if (pads_.stop()) stop();
  ops::RobotDriver* robot = driver();
  if (robot == nullptr || !pads_.action()) return;
  switch (*pads_.action()) {
    case Action::kStand:
      return robot->stand();
    case Action::kReset:
      return robot->reset();
    case Action::kLimp:
      return robot->limp();
    case Action::kLift:
    case Action::kSetDown:
      return robot->hoist(pads_.action() == Action::kLift);
  }
}

Sign GamepadStation::sign() const {
  const ops::RobotNews* robot = news();
  if (driver() == nullptr || robot == nullptr || driver()->silent()) return Sign::kLinkLost;
  if (robot->status.fault_code != 0) return Sign::kFault;
  if (!driver()->driving()) return Sign::kRest;
  const bool limited = robot->status.limited_torque > 0 || (robot->reference && robot->reference->command_limited);
  return limited ? Sign::kLimited : Sign::kDriving;
}

std::string GamepadStation::state(const PadReport& pad) const {
  const Mapping& mapping = pads_.mapping();
  if (pad.missing[mapping.stop])
    return fmt::format("NEITHER DRIVES NOR STOPS: it has no button {}, the stop", kButtonNames[mapping.stop]);
  if (pad.missing[mapping.deadman])
    return fmt::format("stops, but can't drive: it has no button {}, the deadman", kButtonNames[mapping.deadman]);
  return pads_.driving() == pad.id ? "drives" : "stops, and drives when its deadman is held";
}

// A terminal cuts what is longer than its width, so each thought has its line.
std::vector<std::string> GamepadStation::pad_lines(std::span<const PadReport> pads,
                                                   std::span<const UselessPad> useless) const {
  std::vector<std::string> lines;
  for (const PadReport& pad : pads) {
    lines.push_back(io::plain_text(pad.name + ": " + state(pad)));
    const std::string why = pads_.text(pad.id);
    if (why.empty()) continue;
    lines.push_back("  " + why);
    if (pads_.driving() != pad.id)
      lines.push_back(
          fmt::format("  let go of {} and press it with neutral sticks", kButtonNames[pads_.mapping().deadman]));
  }
  for (const UselessPad& pad : useless) {
    lines.push_back(io::plain_text(pad.name + ": NEITHER DRIVES NOR STOPS: " + pad.why));
    lines.push_back("  GUID " + pad.guid);
    lines.push_back(io::plain_text("  " + pad.remedy));
  }
  if (lines.empty()) lines = {"no game controller: plug one in; this user must be able to read /dev/input"};
  return lines;
}

}  // namespace pmg::gamepad
