// What to record next so that two explanations part.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/nested_fit.hpp"

namespace pmg::diagnosis {

/// Models that explain the runs equally well, fitted and linearised, and what they are called.
struct Rivals {
  NestedModel first;
  std::vector<NestedModel> others;
  std::vector<std::string> names;  ///< the first's, then the others'
};

/// Of a small catalogue of commands (steps, slow and fast sweeps, small reversals) at gains and loads like the runs',
/// within the range of their commands: the one that parts the first model from the nearest of the others furthest. What
/// counts is what remains between their rollouts after either was fitted again, along its linearisation, to the runs
/// and to what the other one would do: a rival may absorb the rest. Nothing where all models are the same.
std::optional<NextExcitation> next_excitation(const calib::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                                              const Rivals& rivals);

}  // namespace pmg::diagnosis
