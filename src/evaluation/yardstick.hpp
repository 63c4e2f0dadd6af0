// What a scenario's errors are between: a robot that does nothing, and one that follows the rate-limited command
// perfectly. Both pass through the same averaging as a simulated robot.
#pragma once

#include "evaluation/trial.hpp"

namespace pmg::evaluation {

struct Yardstick {
  TrialResult nothing;   ///< stands upright at its standing height, whatever is asked
  TrialResult follower;  ///< does at once what robot.yaml's ranges and rates let through
};

/// Plays the scenario with the robot hung up, for the controller's modes, gait periods and support phases; what the
/// robot does there doesn't matter. The follower's command is limited as the generator limits the user's (ranges,
/// rates, slower in double support, stops within their time); what the clips can't give together isn't taken off, so a
/// blend that cuts a command is counted against the policy.
Yardstick yardstick(const Candidate& candidate, const sil::Scenario& scenario,
                    const std::function<bool()>& interrupted);

/// (error - follower) / (nothing - follower): 0 a perfect follower, 1 a robot that does nothing. NaN where the scenario
/// asks nothing of a channel.
Errors share_left(const Errors& errors, const Yardstick& between);

}  // namespace pmg::evaluation
