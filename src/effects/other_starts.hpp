// Fits from other values of an effect's parameters, for rollouts whose squares have more than one minimum.
#pragma once

#include <string>
#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// (runs, fitted model, parameters) => (the lowest fit from other values of each of these parameters in turn; the model
/// itself where none is lower by two percent). Rollouts of a joint that sticks or swings by itself are jagged, a hold's
/// delay goes with its period, and a period is out of step a percent beside the right one: a fit may end beside its
/// best. First the others are fitted beside the other value, for a few iterations; where that leaves no less than the
/// model does, it is no start. Costs a Jacobian, ten rollouts of every run for each value, some fifty more where these
/// are promising, and a fit for each start.
NestedModel from_other_starts(const NestedFit& fit, NestedModel model, const std::vector<std::string>& parameters,
                              int most_iterations);

/// The same for periods of holds, on a few runs; fitted to all of them where one is lower there.
NestedModel from_other_periods(const NestedFit& fit, const NestedModel& model, const std::vector<std::string>& periods,
                               int most_iterations);

}  // namespace pmg::effects
