#include "evaluation/table1.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

ordered_json by_error(const Errors& errors) {
  ordered_json json;
  for (std::size_t e = 0; e < kErrors; ++e) json[kErrorKeys[e]] = errors[e];
  return json;
}

ordered_json policy_json(const Table1& table, std::size_t c) {
  ordered_json json = {{"name", table.cases[c].name}, {"policy", table.cases[c].candidate.control.policy}};
  json.update(to_json(table.summaries[c], table.scenario));
  const std::optional<Errors> published = published_errors(table.cases[c].name);
  json["nothing"] = by_error(table.yardsticks[c].nothing.errors);
  json["follower"] = by_error(table.yardsticks[c].follower.errors);
  json["share"] = by_error(table.shares(c));
  json["nothing_raw"] = by_error(table.yardsticks[c].nothing.errors_raw);
  json["follower_raw"] = by_error(table.yardsticks[c].follower.errors_raw);
  json["paper"] = published ? by_error(*published) : ordered_json(nullptr);
  json["runs"] = ordered_json::array();
  for (std::size_t seed = 0; seed < table.campaign.runs[c].size(); ++seed) {
    const TrialResult& run = table.campaign.runs[c][seed];
    if (!run.complete) continue;
    ordered_json entry = {{"seed", seed + 1}};
    entry.update(to_json(run));
    json["runs"].push_back(entry);
  }
  return json;
}

}  // namespace

std::optional<Errors> published_errors(const std::string& policy) {
  if (policy == "single_gait") return Errors{0.0824, 0.4121, 0.1966, 0.3891, 0.0873};
  if (policy == "without_gco") return Errors{0.3762, 0.5131, 0.1595, 0.1981, 0.0656};
  if (policy == "pmg") return Errors{0.1228, 0.1612, 0.0769, 0.0697, 0.0351};
  return std::nullopt;
}

Errors Table1::shares(std::size_t c) const {
  Errors mean{};
  for (std::size_t e = 0; e < kErrors; ++e) mean[e] = summaries[c].errors[e].mean;
  return share_left(mean, yardsticks[c]);
}

double Table1::figure(std::size_t error) const {
  return gentle() ? summaries[judged].errors[error].mean : shares(judged)[error];
}

bool Table1::measured() const {
  return summaries[judged].trials > 0 && (gentle() || yardsticks[judged].nothing.complete);
}

/// A channel without any command in the scenario has no share and passes.
bool Table1::reached(std::size_t error) const {
  return measured() && (figure(error) <= limit(error) || (!gentle() && std::isnan(figure(error))));
}

work::Worth worth_of(const Table1& table) {
  work::Worth worth = whole(table.campaign);
  const std::string& name = table.cases[table.judged].name;
  const CaseSummary& judged = table.summaries[table.judged];
  if (judged.trials == 0) return worth;
  worth.add_if(judged.falls > 0, work::Grade::kMissed,
               fmt::format("{} fell in {} of {} runs", name, judged.falls, judged.trials));
  for (std::size_t e = 0; table.measured() && e < kErrors; ++e) {
    if (table.reached(e)) continue;
    worth.add(work::Grade::kMissed,
              table.gentle() ? fmt::format("{}'s {} error {:.4f} {} is over {}", name, kErrorNames[e], table.figure(e),
                                           kErrorUnits[e], table.limit(e))
                             : fmt::format("{}'s {} error leaves {:.0f} % of what doing nothing leaves, over {:.0f} %",
                                           name, kErrorNames[e], 100.0 * table.figure(e), 100.0 * table.limit(e)));
  }
  return worth;
}

bool Table1::all_reached() const {
  bool all = summaries[judged].falls == 0;
  for (std::size_t e = 0; e < kErrors; ++e) all = all && reached(e);
  return all;
}

Comparison compare(const Case& policy, const std::vector<TrialResult>& runs, const Case& other,
                   const std::vector<TrialResult>& other_runs) {
  Comparison comparison{.policy = policy.name, .other = other.name, .pairs = 0, .difference = {}};
  std::array<std::vector<double>, kErrors> a, b;
  for (std::size_t seed = 0; seed < std::min(runs.size(), other_runs.size()); ++seed) {
    if (!runs[seed].complete || !other_runs[seed].complete) continue;
    ++comparison.pairs;
    for (std::size_t e = 0; e < kErrors; ++e) {
      a[e].push_back(runs[seed].errors[e]);
      b[e].push_back(other_runs[seed].errors[e]);
    }
  }
  for (std::size_t e = 0; e < kErrors; ++e) comparison.difference[e] = paired_difference(a[e], b[e]);
  return comparison;
}

void measure_yardsticks(Table1& table, const Supervision& supervision) {
  const std::vector<sil::Scenario> scenarios = table.in_phases();
  std::vector<std::vector<Yardstick>> all(table.cases.size(), std::vector<Yardstick>(scenarios.size()));
  for_each_piece(table.cases.size() * scenarios.size(), supervision, [&](std::size_t piece) {
    const std::size_t c = piece / scenarios.size(), phase = piece % scenarios.size();
    all[c][phase] = yardstick(table.cases[c].candidate, scenarios[phase], supervision.progress);
  });
  table.yardsticks.clear();
  for (const std::vector<Yardstick>& of_case : all) table.yardsticks.push_back(mean(of_case));
  for (const Yardstick& one : table.yardsticks)
    table.campaign.complete = table.campaign.complete && one.nothing.complete;
}

void evaluate(Table1& table) {
  const auto named_pmg = std::ranges::find(table.cases, "pmg", &Case::name);
  table.judged = named_pmg != table.cases.end() ? static_cast<std::size_t>(named_pmg - table.cases.begin()) : 0;
  table.summaries.clear();
  table.comparisons.clear();
  for (const auto& runs : table.campaign.runs) table.summaries.push_back(summarise(runs));
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    if (c == table.judged) continue;
    table.comparisons.push_back(
        compare(table.cases[table.judged], table.campaign.runs[table.judged], table.cases[c], table.campaign.runs[c]));
  }
}

ordered_json to_json(const Table1& table) {
  ordered_json json = {
      {"kind", "table1"},
      {"complete", table.campaign.complete},
      {"robot", table.robot},
      {"scenario", table.scenario_file},
      {"duration_s", table.scenario.duration_s()},
      {"variation", table.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(table.ranges_file)},
      {"seeds", table.seeds},
      {"gait_phases", kPhases},
      {"limits",
       {{"policy", table.cases[table.judged].name}, {"of", table.gentle() ? "errors" : "share"}, {"falls", 0}}}};
  for (std::size_t e = 0; e < kErrors; ++e) {
    json["limits"][kErrorKeys[e]] = {{"limit", table.limit(e)}, {"reached", table.reached(e)}};
  }
  json["limits"]["all_reached"] = table.all_reached();
  for (std::size_t c = 0; c < table.cases.size(); ++c) json["policies"].push_back(policy_json(table, c));
  json["differences"] = ordered_json::array();
  for (const Comparison& comparison : table.comparisons) {
    ordered_json entry = {{"policy", comparison.policy}, {"minus", comparison.other}, {"pairs", comparison.pairs}};
    for (std::size_t e = 0; e < kErrors; ++e) {
      entry[kErrorKeys[e]] = to_json(comparison.difference[e]);
      entry[kErrorKeys[e]]["excludes_zero"] = comparison.difference[e].excludes_zero();
    }
    json["differences"].push_back(entry);
  }
  json["films"] = table.films;
  json["plants"] = ordered_json::array();
  for (std::size_t seed = 0; seed < table.plants.size(); ++seed) {
    ordered_json entry = {{"seed", seed + 1}};
    entry.update(plant_json(table.plants[seed]));
    json["plants"].push_back(entry);
  }
  return json;
}

}  // namespace pmg::evaluation
