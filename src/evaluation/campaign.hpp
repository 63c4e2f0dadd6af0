// Many trials: every case under the same seeds, in parallel.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/course.hpp"
#include "evaluation/parallel.hpp"
#include "evaluation/statistics.hpp"
#include "evaluation/trial.hpp"
#include "sim/variation.hpp"

namespace pmg::evaluation {

/// Where simulated robots come from. A seed is the same robot, ground and noise for every policy.
struct Plants {
  std::optional<sim::VariationRanges> ranges;  ///< nothing: as the model says, sensor noise as pmg_sil's
  /// What a case asks for on top, whatever was drawn; may be empty.
  std::function<void(sim::WorldOptions&)> fixed;

  sim::WorldOptions of(const model::RobotModel& robot, std::uint64_t seed) const;
};

/// The scalars of a drawn world, for people who ask why a seed fell.
nlohmann::ordered_json plant_json(const sim::WorldOptions& world);

/// One column of trials.
struct Case {
  std::string name;
  Candidate candidate;
  Plants plants;
};

/// runs[case][seed]; a trial that was not begun or not ended is not complete.
struct CampaignRuns {
  std::vector<std::vector<TrialResult>> runs;
  std::vector<Course> courses;  ///< by case, of its first seed
  bool complete = true;
};

/// Seeds 1 .. seeds. The result doesn't depend on how many jobs there are.
CampaignRuns run_campaign(const std::vector<Case>& cases, const sil::Scenario& scenario, int seeds, bool gantry,
                          const Supervision& supervision);

/// Films a case's first seed, as far as the supervision lets it. Returns what went wrong with the film, one line;
/// empty: nothing.
std::string film_case(const Case& filmed, const sil::Scenario& scenario, const std::filesystem::path& file,
                      const Supervision& supervision);

/// Of the complete trials of one case.
struct CaseSummary {
  int trials = 0, falls = 0, survived = 0;
  std::array<Estimate, kErrors> errors;
  std::array<Estimate, kErrors> errors_raw;           ///< velocities not averaged over a gait period
  std::array<Estimate, kErrors> errors_beyond_reach;  ///< of the steps that ask for more than clips give together
  std::vector<Errors> step_errors;                    ///< means over seeds, by step of the scenario
};
CaseSummary summarise(const std::vector<TrialResult>& runs);

nlohmann::ordered_json to_json(const Estimate& estimate);  ///< {"mean", "ci95": [lower, upper]}
nlohmann::ordered_json to_json(const TrialResult& trial);
nlohmann::ordered_json to_json(const CaseSummary& summary, const sil::Scenario& scenario);

}  // namespace pmg::evaluation
