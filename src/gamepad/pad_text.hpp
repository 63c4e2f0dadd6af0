// What a driver of game controllers is shown, on the pads and in text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gamepad/pad_command.hpp"
#include "operator/driving_station.hpp"

namespace pmg::gamepad {

/// The state that the pads show with light and rumble; a later one hides an earlier one.
enum class Sign { kRest, kDriving, kLimited, kLinkLost, kFault };
Sign sign(const ops::DrivingStation& station);

/// What each pad does, or why it does nothing.
std::vector<std::string> pad_lines(const PadCommand& command, const ops::DrivingStation& station,
                                   std::span<const PadReport> pads, std::span<const UselessPad> useless);

}  // namespace pmg::gamepad
