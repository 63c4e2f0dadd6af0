// How late and how fast a command takes effect, found where the torques balance best.
#pragma once

#include "evidence/cluster_regression.hpp"
#include "evidence/torque_balance.hpp"
#include "evidence/verdict.hpp"

namespace pmg::evidence {

struct FoundShape {
  Interval delay_s;
  double delay_gain = 0.0;  ///< share of the balance's residual that the delay removes, -inf..1
  /// Infinite where a limit makes nothing better; low and high are the range in which it is as good.
  Interval rate_limit_rad_s;
  Interval rate_gain;  ///< share of the balance's residual that the limit removes
  bool known = false;  ///< false where too little moves
};

/// Sets the balance to the shape found, as far as it is sure: what isn't stays neutral.
FoundShape find_shape(TorqueBalance& balance, unsigned seed = 1);

}  // namespace pmg::evidence
