// Whether a policy walks a scenario under conditions at the end of what robots meet.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// The conditions that a policy is asked to bear, as cases of one candidate: as pmg_sil simulates it, 1.5 kg in each
/// hand, friction 0.4 and 1.2, 20 ms from action to torque, and the first, second and last of these at once. plants:
/// what differs besides.
std::vector<Case> robustness_cases(const Candidate& candidate, const Plants& plants);

struct RobustnessTest {
  std::string robot, scenario_file, ranges_file;
  sil::Scenario scenario;
  std::vector<Case> cases;
  int seeds = 0;
  CampaignRuns campaign;
  std::vector<CaseSummary> summaries;  ///< by case

  bool all_survived() const;
};

void evaluate(RobustnessTest& test);  ///< fills summaries

nlohmann::ordered_json to_json(const RobustnessTest& test);
pages::Page page_of(const RobustnessTest& test);
std::vector<std::string> text_of(const RobustnessTest& test);

}  // namespace pmg::evaluation
