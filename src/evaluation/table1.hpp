// The paper's Table I: how well policies follow the same sequence of commands on the same simulated robots.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "evaluation/yardstick.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// What a policy of this project shall reach on the gentle sequence (config/scenarios/table1.yaml): half of what the
/// paper's did, and on linear velocity less than its baseline's. A robot that stands still comes near to that there.
inline constexpr Errors kErrorLimits = {0.06, 0.08, 0.035, 0.035, 0.0175};
inline constexpr const char* kGentleScenario = "table1";

/// On every other sequence: of what lies between a perfect follower and doing nothing (share_left).
inline constexpr Errors kShareLimits = {0.15, 0.15, 0.20, 0.15, 0.15};

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
  sil::Scenario scenario;
  std::vector<Case> cases;
  int seeds = 0;
  CampaignRuns campaign;
  std::vector<Yardstick> yardsticks;   ///< by case
  std::vector<CaseSummary> summaries;  ///< by case
  std::vector<Comparison> comparisons;
  std::size_t judged = 0;                 ///< case that is held against limits and others: "pmg", or the first
  std::vector<sim::WorldOptions> plants;  ///< by seed

  std::vector<std::string> films;  ///< files beside the page

  bool gentle() const { return scenario.name == kGentleScenario; }
  Errors shares(std::size_t c) const;      ///< share_left of a case's mean errors
  double figure(std::size_t error) const;  ///< of the judged policy, as its limit counts it: mean error or share
  double limit(std::size_t error) const { return gentle() ? kErrorLimits[error] : kShareLimits[error]; }
  bool reached(std::size_t error) const;  ///< the judged policy's figure is within its limit
  bool all_reached() const;               ///< and it never fell
};

/// Fills yardsticks: a run with the robot hung up for each case.
void measure_yardsticks(Table1& table, const Supervision& supervision);

/// Fills summaries, comparisons and judged from cases, campaign and yardsticks.
void evaluate(Table1& table);

/// Paired over the seeds that both have ended.
Comparison compare(const Case& policy, const std::vector<TrialResult>& runs, const Case& other,
                   const std::vector<TrialResult>& other_runs);

nlohmann::ordered_json to_json(const Table1& table);
pages::Page page_of(const Table1& table);
std::vector<std::string> text_of(const Table1& table);  ///< lines for a console

}  // namespace pmg::evaluation
