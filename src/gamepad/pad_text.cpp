#include "gamepad/pad_text.hpp"

#include <fmt/format.h>

#include "io/plain_text.hpp"

namespace pmg::gamepad {

namespace {

std::string state(const PadReport& pad, const Mapping& mapping, bool drives) {
  if (pad.missing[mapping.stop])
    return fmt::format("NEITHER DRIVES NOR STOPS: it has no button {}, the stop", kButtonNames[mapping.stop]);
  if (pad.missing[mapping.deadman])
    return fmt::format("stops, but can't drive: it has no button {}, the deadman", kButtonNames[mapping.deadman]);
  return drives ? "drives" : "stops, and drives when its deadman is held";
}

}  // namespace

Sign sign(const ops::DrivingStation& station) {
  const ops::RobotNews* robot = station.news();
  const ops::RobotDriver* driver = station.driver();
  if (driver == nullptr || robot == nullptr || driver->silent()) return Sign::kLinkLost;
  if (robot->status.fault_code != 0) return Sign::kFault;
  if (!driver->driving()) return Sign::kRest;
  const pmg_msgs::reference_t* reference = ops::reference_in_force(*robot);
  const bool limited = robot->status.limited_torque > 0 || (reference != nullptr && reference->command_limited);
  return limited ? Sign::kLimited : Sign::kDriving;
}

// A terminal cuts what is longer than its width, so each thought has its line.
std::vector<std::string> pad_lines(const PadCommand& command, const ops::DrivingStation& station,
                                   std::span<const PadReport> pads, std::span<const UselessPad> useless) {
  const Mapping& mapping = command.mapping();
  const ops::RobotDriver* driver = station.driver();
  std::vector<std::string> lines;
  for (const PadReport& pad : pads) {
    const bool drives = driver != nullptr && driver->hold().armed() == pad.id;
    const bool refused = driver != nullptr && driver->hold().refused(pad.id);
    lines.push_back(io::plain_text(pad.name + ": " + state(pad, mapping, drives)));
    const std::string why = refused ? "a stick isn't neutral" : command.text(pad.id);
    if (why.empty()) continue;
    lines.push_back("  " + why);
    if (!drives)
      lines.push_back(fmt::format("  let go of {} and press it with neutral sticks", kButtonNames[mapping.deadman]));
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
