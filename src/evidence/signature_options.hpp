// Thresholds of the model-free checks.
#pragma once

#include <vector>

#include "evidence/option.hpp"

namespace pmg::evidence {

/// Each share is relative to the drive's root mean square. listed() gives units and reasons.
struct SignatureOptions {
  double sure_deviations = 4.0;
  double friction_share = 0.010, constant_share = 0.003, drive_share = 0.012;
  double disagrees_share = 0.4;
  double own_share = 0.1;
  double fewest_clusters = 15.0;
  double rest_worth_rad = 1e-3;
  double swing_worth_share = 0.03;
  double swing_fewest_clusters = 6.0;
  double quantum_fewest_readings = 20.0;
  double quantum_rounding = 0.08;
  double quantum_coarse_rad = 1e-4;
};

/// Every number of the struct, in its order.
std::vector<Option> listed(const SignatureOptions& options);

}  // namespace pmg::evidence
