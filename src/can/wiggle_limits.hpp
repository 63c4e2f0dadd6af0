// What first movements take for enough, for joints of their own and for joints of a linkage.
#pragma once

#include "hal/bus_cycle.hpp"
#include "pmg/types.hpp"

namespace pmg::can {

inline constexpr double kCycle_s = static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9;
inline constexpr int kSettleCycles = 100;              // 0.2 s at each end
inline constexpr int kRestCycles = kSettleCycles / 2;  // of them at rest: means are taken there
inline constexpr double kLeastWay_rad = 3.0 * kRadPerDegree;
inline constexpr double kNoWay_rad = 0.4 * kRadPerDegree;      // less than can be asked for: the joint lies on its stop
inline constexpr double kLeastShare = 0.5;                     // of the way asked for, with soft gains and dry friction
inline constexpr double kOnStop_rad = 0.02;                    // a limp joint that lies on its stop
inline constexpr double kLeastLean_rad = 0.5 * kRadPerDegree;  // sway and the steps of an IMU's values are less
inline constexpr double kSureOfLean = 2.0;  // times what the base lacks when the joint is back: friction holds it there
// Share of the way that a base turns which a joint turns. Less, and something else than --held holds the robot.
inline constexpr double kLeastTurn = 0.3;
// Frictions that a load must have to be compared.
inline constexpr double kSure = 3.0;
// Friction of opposite ways cancels out of the mean of both. What one way round would hold is ruled out when the mean
// of both ways is more frictions off than this; it was off by up to 1.4 for the right one where nothing touched the
// limb: the base still moves a little. The other explains the mean within one friction, or within this share of itself:
// a drive's torque constant.
inline constexpr double kRuledOut = 2.0, kExplains = 0.3;
// By which a way, mirrored, leaves the joint's range: a zero that was set by eye is off by less.
inline constexpr double kSureOfRange_rad = 10.0 * kRadPerDegree;
// What a stop gives way, and the zero's error, where something ends a way. A joint that didn't come there may be
// braked.
inline constexpr double kNearStop_rad = 3.0 * kRadPerDegree, kCame_rad = 1.0 * kRadPerDegree;

/// It moved less than it should have. Where a joint lies on its stop, a way is too short to tell.
constexpr bool is_short(double asked_rad, double moved_rad, double telling_rad) {
  return asked_rad > telling_rad && moved_rad < kLeastShare * asked_rad;
}

}  // namespace pmg::can
