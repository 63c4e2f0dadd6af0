// A command's dead time and rate limit: those with which the torques balance best.
#pragma once

#include "evidence/cluster_regression.hpp"
#include "evidence/torque_balance.hpp"
#include "evidence/verdict.hpp"

namespace pmg::evidence {

struct FoundShape {
  Interval delay_s;
  double delay_gain = 0.0;    ///< share of the balance's squared residual that the delay removes, 0..1
  Interval rate_limit_rad_s;  ///< best limit, with a 95 % bootstrap interval; infinite where the search was not run
  Interval rate_gain;         ///< share of the balance's squared residual that the limit removes, -inf..1
  bool known = false;         ///< false if too little moves
};

/// (balance) => (best shape). Sets the balance to the shape found; a delay or a limit that is not significant stays
/// neutral. 95 % intervals are a bootstrap over clusters, seeded. collinear_share: of BalanceOptions.
FoundShape find_shape(TorqueBalance& balance, const ShapeOptions& options, double collinear_share, unsigned seed = 1);

}  // namespace pmg::evidence
