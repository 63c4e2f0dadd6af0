// What an operator wants of the robot's arms, as plain data that fits a mailbox (pmg_msgs::arms_t).
#pragma once

#include <cstdint>

#include "arms/palm.hpp"
#include "control/mode.hpp"

namespace pmg::control {

/// The numbers are those of pmg_msgs::arms_t.
enum class ArmWish : std::uint8_t {
  kHold = 0,      ///< stay where it is
  kAim = 1,       ///< the palm to its target
  kHandBack = 2,  ///< let the reference move it again
};

struct ArmTarget {
  ArmWish wish = ArmWish::kHold;
  arms::PalmPose palm;  ///< counts with kAim only

  friend bool operator==(const ArmTarget& a, const ArmTarget& b) {
    return a.wish == b.wish && a.palm.p_m == b.palm.p_m && a.palm.R.coeffs() == b.palm.R.coeffs();
  }
};

struct ArmsMessage {
  Source source;
  std::int64_t sequence = 0;     ///< increases with every message of a session
  std::int64_t stamp_ns = 0;     ///< by the sender's clock
  std::int64_t received_ns = 0;  ///< by the receiver's
  double lease_s = 0.0;          ///< how long it is in force
  arms::PerArm<ArmTarget> arm{};
};

/// What the driving source's newest message does; the numbers are those of pmg_msgs::arms_state_t.
enum class ArmsOrder : std::uint8_t { kInForce = 0, kNoneCame = 1, kLeaseOver = 2, kNotWalking = 3 };

}  // namespace pmg::control
