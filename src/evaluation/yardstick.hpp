// The ends of an error scale for a scenario: a robot that does nothing, and one that follows the rate-limited command
// perfectly. Both errors are averaged as a simulated robot's.
#pragma once

#include <vector>

#include "evaluation/trial.hpp"

namespace pmg::evaluation {

struct Yardstick {
  TrialResult nothing;   ///< stands upright at its standing height, whatever the command
  TrialResult follower;  ///< follows immediately, within robot.yaml's ranges and rates
};

/// Plays the scenario with the robot on the gantry, for the controller's modes, gait periods and support phases; the
/// robot's motion doesn't matter. The follower's command has the generator's limits (ranges, rates, slower in double
/// support, stops within their time). The clips' common reach does not limit it, so a blend that cuts a command counts
/// against the policy.
Yardstick yardstick(const Candidate& candidate, const sil::Scenario& scenario, const work::Progress& progress);

/// Of runs of one course in several gait phases: the means of their errors, complete if all are.
Yardstick mean(const std::vector<Yardstick>& all);

/// (error - follower) / (nothing - follower): 0 for a perfect follower, 1 for a robot that does nothing. NaN where the
/// scenario commands nothing in a channel.
Errors share_left(const Errors& errors, const Yardstick& between);

}  // namespace pmg::evaluation
