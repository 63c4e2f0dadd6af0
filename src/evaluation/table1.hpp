// The paper's Table I: how well policies follow the same sequence of commands on the same simulated robots.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// What a policy of this project shall reach: half of what the paper's did, and on linear velocity less than its
/// baseline's.
inline constexpr Errors kErrorLimits = {0.06, 0.08, 0.035, 0.035, 0.0175};

/// The paper's figures for this kind of policy (Table I); nothing for names that it doesn't know.
std::optional<Errors> published_errors(const std::string& policy);

/// PMG - another policy, by seed.
struct Comparison {
  std::string policy, other;
  int pairs = 0;
  std::array<Estimate, kErrors> difference;
};

struct Table1 {
  std::string robot, scenario_file, ranges_file;  ///< as the user named them; ranges_file empty: as the model says
  runtime::Scenario scenario;
  std::vector<Case> cases;
  int seeds = 0;
  CampaignRuns campaign;
  std::vector<CaseSummary> summaries;  ///< by case
  std::vector<Comparison> comparisons;
  std::size_t judged = 0;                 ///< case that is held against limits and others: "pmg", or the first
  std::vector<sim::WorldOptions> plants;  ///< by seed

  std::vector<std::string> films;  ///< files beside the page

  bool reached(std::size_t error) const;  ///< the judged policy's mean is within its limit
  bool all_reached() const;               ///< and it never fell
};

/// Fills summaries, comparisons and judged from cases and campaign.
void evaluate(Table1& table);

/// Paired over the seeds that both have ended.
Comparison compare(const Case& policy, const std::vector<TrialResult>& runs, const Case& other,
                   const std::vector<TrialResult>& other_runs);

nlohmann::ordered_json to_json(const Table1& table);
pages::Page page_of(const Table1& table);
std::vector<std::string> text_of(const Table1& table);  ///< lines for a console

}  // namespace pmg::evaluation
