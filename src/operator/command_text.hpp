// Commands for people and for JSON: units, what counts as the same.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "pmg/command.hpp"

namespace pmg::ops {

inline constexpr std::array kCommandUnits = {"m/s", "m/s", "rad/s", "rad", "rad", "m"};
static_assert(kCommandUnits.size() == kChannels);

/// How far two values of a channel are apart, as a share of the larger one; near zero, of 0.1 m/s, rad/s, rad or m.
double share_apart(double a, double b);

/// Rounded for people: to a hundredth, near zero to a thousandth.
bool alike(double a, double b);

/// By kChannelNames.
nlohmann::ordered_json command_json(std::span<const double, kChannels> u);

}  // namespace pmg::ops
