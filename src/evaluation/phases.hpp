// A course in several gait phases.
#pragma once

#include <vector>

#include "sil/scenario.hpp"

namespace pmg::evaluation {

/// (scenario) => (that scenario so many times, each with its walks in another gait phase). Steps of a course change
/// the command in the same phase on every robot, because a walk begins in the same phase after each rest; but which
/// foot carries when a command changes decides how soon it is carried out. So in the k-th each step that begins to walk
/// lasts k / phases s longer, about that share of a gait period, and this part isn't judged. The first is the scenario
/// itself.
std::vector<sil::Scenario> in_phases(const sil::Scenario& scenario, int phases);

}  // namespace pmg::evaluation
