#include "evaluation/phases.hpp"

#include <algorithm>

namespace pmg::evaluation {

namespace {

bool walks(const sil::ScenarioStep& step) {
  const auto& u = step.command.u;
  return step.mode == control::Mode::kWalk &&
         std::any_of(u.begin(), u.begin() + kVelocityChannels, [](double value) { return value != 0.0; });
}

}  // namespace

std::vector<sil::Scenario> in_phases(const sil::Scenario& scenario, int phases) {
  std::vector<sil::Scenario> all;
  for (int k = 0; k < phases; ++k) {
    sil::Scenario& one = all.emplace_back(scenario);
    double later_s = 0.0;
    bool walked = false;
    for (sil::ScenarioStep& step : one.steps) {
      step.start_s += later_s;
      if (walks(step) && !walked) {
        step.unjudged_s = static_cast<double>(k) / phases;
        step.duration_s += step.unjudged_s;
        later_s += step.unjudged_s;
      }
      walked = walks(step);
    }
  }
  return all;
}

}  // namespace pmg::evaluation
