// Observations and the actions that a network's makers computed for them; replayed when a policy is loaded.
#pragma once

#include <vector>

namespace pmg::policy {

class OnnxNetwork;

struct GoldenPair {
  std::vector<float> observation, action;
};

/// Runs a bound network over the pairs, whose sizes fit it. Throws std::invalid_argument with the first action that
/// differs by more than the tolerance, in the network's unit.
void replay_golden_pairs(OnnxNetwork& network, const std::vector<GoldenPair>& pairs, double tolerance);

}  // namespace pmg::policy
