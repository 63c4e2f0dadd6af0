#include "evaluation/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sil/film.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

ordered_json errors_json(const Errors& errors) {
  ordered_json json;
  for (std::size_t e = 0; e < kErrors; ++e) json[kErrorKeys[e]] = errors[e];  // NaN becomes null
  return json;
}

}  // namespace

sim::WorldOptions Plants::of(const model::RobotModel& robot, std::uint64_t seed) const {
  sim::WorldOptions world = sil::world_with_noise(seed, false);
  if (ranges) sim::vary(world, *ranges, robot, seed);
  if (fixed) fixed(world);
  return world;
}

ordered_json plant_json(const sim::WorldOptions& world) {
  const sim::Variation& v = world.variation;
  return {{"friction", world.floor_friction},
          {"torso_mass_kg", v.torso_mass_kg},
          {"torso_center_of_mass_m",
           {v.torso_center_of_mass_m.x(), v.torso_center_of_mass_m.y(), v.torso_center_of_mass_m.z()}},
          {"hand_payload_kg", {v.hand_payload_kg[kLeft], v.hand_payload_kg[kRight]}},
          {"delay_s", v.delay_s}};
}

work::Worth whole(const CampaignRuns& campaign) {
  std::size_t all = 0, complete = 0;
  for (const std::vector<TrialResult>& runs : campaign.runs) {
    all += runs.size();
    complete += static_cast<std::size_t>(std::ranges::count_if(runs, &TrialResult::complete));
  }
  if (campaign.complete) return {};
  return {work::Grade::kInterrupted, fmt::format("{} of {} runs are complete", complete, all)};
}

CampaignRuns run_campaign(const std::vector<Case>& cases, const std::vector<sil::Scenario>& scenarios, int seeds,
                          bool gantry, const Supervision& supervision) {
  CampaignRuns campaign;
  campaign.runs.assign(cases.size(), std::vector<TrialResult>(static_cast<std::size_t>(seeds)));
  campaign.courses.resize(cases.size());
  std::vector<model::RobotModel> robots;
  for (const Case& c : cases) robots.push_back(control::load_robot(c.candidate.control));
  // seed by seed, so that an interruption leaves paired results
  for_each_piece(cases.size() * static_cast<std::size_t>(seeds), supervision, [&](std::size_t piece) {
    const std::size_t c = piece % cases.size(), seed = piece / cases.size();
    TrialOptions options{.gantry = gantry, .progress = supervision.progress, .observer = {}};
    if (seed == 0) {
      options.observer = [recorder = CourseRecorder(campaign.courses[c], robots[c].standing_height_m)](
                             const sil::RunProgress& now, sim::World& world) mutable {
        recorder.add(now, world.truth());
        return true;
      };
    }
    campaign.runs[c][seed] = run_trial(cases[c].candidate, scenarios[seed % scenarios.size()],
                                       cases[c].plants.of(robots[c], seed + 1), options);
  });
  for (const auto& runs : campaign.runs) {
    for (const TrialResult& run : runs) campaign.complete = campaign.complete && run.complete;
  }
  return campaign;
}

std::string film_case(const Case& filmed, const sil::Scenario& scenario, const std::filesystem::path& file,
                      const Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(filmed.candidate.control);
  std::optional<sil::Film> film;
  const auto shoot = [&](const sil::RunProgress& now, sim::World& world) {
    if (!film) film.emplace(world, file);
    film->after_tick(now);
    return film->failure().empty();
  };
  try {
    run_trial(filmed.candidate, scenario, filmed.plants.of(robot, 1),
              {.gantry = false, .progress = supervision.progress, .observer = shoot});
  } catch (const std::runtime_error& error) {  // no OSMesa
    return error.what();
  }
  if (film) film->close();
  return film ? film->failure() : "";
}

CaseSummary summarise(const std::vector<TrialResult>& runs) {
  CaseSummary summary;
  std::array<std::vector<double>, kErrors> samples, raw, beyond;
  for (const TrialResult& run : runs) {
    if (!run.complete) continue;
    ++summary.trials;
    summary.falls += run.fell ? 1 : 0;
    summary.survived += run.survived() ? 1 : 0;
    if (run.judged_s <= 0.0) continue;
    for (std::size_t e = 0; e < kErrors; ++e) {
      samples[e].push_back(run.errors[e]);
      raw[e].push_back(run.errors_raw[e]);
      if (run.errors_beyond_reach) beyond[e].push_back((*run.errors_beyond_reach)[e]);
    }
    summary.step_errors.resize(std::max(summary.step_errors.size(), run.step_errors.size()), Errors{});
  }
  for (std::size_t e = 0; e < kErrors; ++e) {
    summary.errors[e] = mean_interval(samples[e]);
    summary.errors_raw[e] = mean_interval(raw[e]);
    summary.errors_beyond_reach[e] = mean_interval(beyond[e]);
  }
  for (std::size_t step = 0; step < summary.step_errors.size(); ++step) {
    int count = 0;
    for (const TrialResult& run : runs) {
      if (!run.complete || step >= run.step_errors.size() || std::isnan(run.step_errors[step][0])) continue;
      ++count;
      for (std::size_t e = 0; e < kErrors; ++e) summary.step_errors[step][e] += run.step_errors[step][e];
    }
    for (double& error : summary.step_errors[step]) {
      error = count > 0 ? error / count : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return summary;
}

std::vector<std::string> error_columns(const std::string& first) {
  std::vector<std::string> columns = {first};
  for (std::size_t e = 0; e < kErrors; ++e) columns.push_back(fmt::format("{} [{}]", kErrorNames[e], kErrorUnits[e]));
  return columns;
}

std::string interval_text(const Estimate& estimate) {
  if (!std::isfinite(estimate.upper)) return fmt::format("{:.4f}", estimate.mean);
  return fmt::format("{:.4f} +-{:.4f}", estimate.mean, estimate.upper - estimate.mean);
}

ordered_json to_json(const Estimate& estimate) {
  return {{"mean", estimate.mean}, {"ci95", {estimate.lower, estimate.upper}}};
}

ordered_json to_json(const TrialResult& trial) {
  return {{"fell", trial.fell},
          {"fell_at_s", trial.fell ? ordered_json(trial.fell_at_s) : ordered_json(nullptr)},
          {"faults", trial.faults},
          {"judged_s", trial.judged_s},
          {"errors", errors_json(trial.errors)},
          {"errors_raw", errors_json(trial.errors_raw)}};
}

ordered_json to_json(const CaseSummary& summary, const sil::Scenario& scenario) {
  ordered_json json = {{"trials", summary.trials}, {"falls", summary.falls}, {"survived", summary.survived}};
  for (std::size_t e = 0; e < kErrors; ++e) {
    json["errors"][kErrorKeys[e]] = to_json(summary.errors[e]);
    json["errors_raw"][kErrorKeys[e]] = to_json(summary.errors_raw[e]);
    json["errors_beyond_reach"][kErrorKeys[e]] = to_json(summary.errors_beyond_reach[e]);
  }
  json["segments"] = ordered_json::array();
  for (std::size_t step = 0; step < summary.step_errors.size() && step < scenario.steps.size(); ++step) {
    json["segments"].push_back({{"text", scenario.steps[step].text},
                                {"for_s", scenario.steps[step].duration_s},
                                {"command", scenario.steps[step].command.u},
                                {"beyond_reach", scenario.steps[step].beyond_reach},
                                {"errors", errors_json(summary.step_errors[step])}});
  }
  return json;
}

}  // namespace pmg::evaluation
