// The paper's Table I: tracking errors of policies on the same commands and the same simulated robots.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "evaluation/phases.hpp"
#include "evaluation/yardstick.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

/// Limits for this project's policies on the gentle sequence (config/scenarios/table1.yaml): about half of the paper's
/// PMG errors, and less than the baseline's for linear velocity. There even a robot that stands still is close to them.
inline constexpr Errors kErrorLimits = {0.06, 0.08, 0.035, 0.035, 0.0175};
inline constexpr const char* kGentleScenario = "table1";

/// Limits on every other sequence, as shares between a perfect follower and doing nothing (share_left).
inline constexpr Errors kShareLimits = {0.15, 0.15, 0.20, 0.15, 0.15};

inline constexpr int kPhases = 4;  ///< of the gait, in which the seeds' commands change

/// The paper's figures for this kind of policy (Table I); nullopt for other names.
std::optional<Errors> published_errors(const std::string& policy);

/// PMG minus another policy, paired by seed.
struct Comparison {
  std::string policy, other;
  int pairs = 0;
  std::array<Estimate, kErrors> difference;
};

struct Table1 {
  std::string robot, scenario_file, ranges_file;  ///< as the user named them; ranges_file empty: the robot model itself
  sil::Scenario scenario;
  /// The seeds take the gait's phases in turn (phases.hpp).
  std::vector<sil::Scenario> in_phases() const { return evaluation::in_phases(scenario, kPhases); }
  std::vector<Case> cases;
  int seeds = 0;
  CampaignRuns campaign;
  std::vector<Yardstick> yardsticks;   ///< by case
  std::vector<CaseSummary> summaries;  ///< by case
  std::vector<Comparison> comparisons;
  std::size_t judged = 0;                 ///< the case held against the limits and the others: "pmg", or the first
  std::vector<sim::WorldOptions> plants;  ///< by seed

  std::vector<std::string> films;  ///< files beside the page

  bool gentle() const { return scenario.name == kGentleScenario; }
  Errors shares(std::size_t c) const;      ///< share_left of a case's mean errors
  double figure(std::size_t error) const;  ///< of the judged policy: mean error or share, as its limit counts
  double limit(std::size_t error) const { return gentle() ? kErrorLimits[error] : kShareLimits[error]; }
  bool measured() const;                  ///< what the limits hold against: errors or, for shares, yardsticks, too
  bool reached(std::size_t error) const;  ///< figure(error) is within its limit, or nothing was asked of that channel
  bool all_reached() const;               ///< all errors reached, and no fall
};

work::Worth worth_of(const Table1& table);

/// Fills yardsticks by one run per case and gait phase with the robot on the gantry: their means over the phases.
void measure_yardsticks(Table1& table, const Supervision& supervision);

/// Fills summaries, comparisons and judged from cases, campaign and yardsticks.
void evaluate(Table1& table);

/// Paired over the seeds that both policies completed.
Comparison compare(const Case& policy, const std::vector<TrialResult>& runs, const Case& other,
                   const std::vector<TrialResult>& other_runs);

nlohmann::ordered_json to_json(const Table1& table);
pages::Page page_of(const Table1& table);
std::vector<pages::Table> tables_of(const Table1& table);  ///< of the page and of a console

}  // namespace pmg::evaluation
