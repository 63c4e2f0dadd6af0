// (what a robot is asked for) => the side that a film shows it from.
#pragma once

#include <optional>

#include "pmg/command.hpp"

namespace pmg::sil {

/// Azimuths of the line of sight about z from the robot's heading [deg].
inline constexpr double kFromTheFront_deg = 180.0, kFromTheFrontAndLeft_deg = 216.0, kFromTheLeft_deg = 270.0;

/// Motion along the line of sight can't be seen: walking ahead and back, bending and squatting are seen from the left;
/// steps to the side and leaning, also while it walks, from the front; turning and the rest from between. Nothing:
/// nothing is asked for, any side will do.
std::optional<double> shown_from_deg(const Command& asked);

}  // namespace pmg::sil
