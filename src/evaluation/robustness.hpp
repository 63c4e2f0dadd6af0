// Survival of a scenario under conditions at the limits of practice.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// The conditions, as cases of one candidate: pmg_sil's own simulation, 1.5 kg in each hand, friction 0.4, friction
/// 1.2, 20 ms from action to torque, and payload, low friction and delay together. plants: variation in addition to the
/// condition; the first case has none.
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

work::Worth worth_of(const RobustnessTest& test);
void evaluate(RobustnessTest& test);  ///< fills summaries

nlohmann::ordered_json to_json(const RobustnessTest& test);
pages::Page page_of(const RobustnessTest& test);
std::vector<pages::Table> tables_of(const RobustnessTest& test);

}  // namespace pmg::evaluation
