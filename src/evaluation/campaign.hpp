// Many trials in parallel; every case meets the same seeds.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/course.hpp"
#include "evaluation/statistics.hpp"
#include "evaluation/supervision.hpp"
#include "evaluation/trial.hpp"
#include "sim/variation.hpp"
#include "work/worth.hpp"

namespace pmg::evaluation {

/// Source of simulated robots. A seed gives the same robot, ground and noise to every policy.
struct Plants {
  std::optional<sim::VariationRanges> ranges;  ///< nullopt: the robot model itself, with pmg_sil's sensor noise
  /// A case's own conditions, applied after the draw; may be empty.
  std::function<void(sim::WorldOptions&)> fixed;

  sim::WorldOptions of(const model::RobotModel& robot, std::uint64_t seed) const;
};

/// The scalars of a drawn world, to find out why a seed fell.
nlohmann::ordered_json plant_json(const sim::WorldOptions& world);

/// One policy on one set of plants.
struct Case {
  std::string name;
  Candidate candidate;
  Plants plants;
};

/// runs[case][seed]; a trial that did not begin or did not end is not complete.
struct CampaignRuns {
  std::vector<std::vector<TrialResult>> runs;
  std::vector<Course> courses;  ///< by case; each of its first seed
  bool complete = true;
};

/// Interrupted, with how many trials are complete; otherwise it holds.
work::Worth whole(const CampaignRuns& campaign);

/// Seeds 1 to `seeds`, which take the scenarios in turn. The result doesn't depend on the number of jobs.
CampaignRuns run_campaign(const std::vector<Case>& cases, const std::vector<sil::Scenario>& scenarios, int seeds,
                          bool gantry, const Supervision& supervision);

/// Films a case's first seed, until the supervision interrupts. Returns the film's error in one line; empty: none.
std::string film_case(const Case& filmed, const sil::Scenario& scenario, const std::filesystem::path& file,
                      const Supervision& supervision);

/// Figures of one case's complete trials.
struct CaseSummary {
  int trials = 0, falls = 0, survived = 0;
  std::array<Estimate, kErrors> errors;
  std::array<Estimate, kErrors> errors_raw;           ///< not averaged over a gait period
  std::array<Estimate, kErrors> errors_beyond_reach;  ///< of the steps that ask for more than the clips give together
  std::vector<Errors> step_errors;                    ///< means over seeds, by step of the scenario
};
CaseSummary summarise(const std::vector<TrialResult>& runs);

/// A table's columns of errors: a name, then each error's with its unit.
std::vector<std::string> error_columns(const std::string& first);
std::string interval_text(const Estimate& estimate);  ///< "0.0489 +-0.0022" of a symmetric interval

nlohmann::ordered_json to_json(const Estimate& estimate);  ///< {"mean", "ci95": [lower, upper]}
nlohmann::ordered_json to_json(const TrialResult& trial);
nlohmann::ordered_json to_json(const CaseSummary& summary, const sil::Scenario& scenario);

}  // namespace pmg::evaluation
