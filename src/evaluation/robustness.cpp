#include "evaluation/robustness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

constexpr double kPayload_kg = 1.5, kLowFriction = 0.4, kHighFriction = 1.2, kDelay_s = 0.02;

Estimate survival(const CaseSummary& summary) { return share_interval(summary.survived, summary.trials); }

}  // namespace

std::vector<Case> robustness_cases(const Candidate& candidate, const Plants& plants) {
  std::vector<Case> cases = {{.name = "as pmg_sil simulates it", .candidate = candidate, .plants = {}}};
  const auto add = [&](const std::string& name, const std::function<void(sim::WorldOptions&)>& fixed) {
    Case c{.name = name, .candidate = candidate, .plants = plants};
    c.plants.fixed = fixed;
    cases.push_back(c);
  };
  const auto carry = [](sim::WorldOptions& world) { world.variation.hand_payload_kg = {kPayload_kg, kPayload_kg}; };
  const auto slow = [](sim::WorldOptions& world) { world.variation.delay_s = kDelay_s; };
  const auto slip = [](sim::WorldOptions& world) { world.floor_friction = kLowFriction; };
  add(fmt::format("{} kg in each hand", kPayload_kg), carry);
  add(fmt::format("friction {}", kLowFriction), slip);
  add(fmt::format("friction {}", kHighFriction),
      [](sim::WorldOptions& world) { world.floor_friction = kHighFriction; });
  add(fmt::format("{:.0f} ms from action to torque", 1000.0 * kDelay_s), slow);
  add("payload, low friction and delay", [=](sim::WorldOptions& world) {
    carry(world);
    slip(world);
    slow(world);
  });
  return cases;
}

bool RobustnessTest::all_survived() const {
  return std::ranges::all_of(summaries, [](const CaseSummary& s) { return s.survived == s.trials; });
}

work::Worth worth_of(const RobustnessTest& test) {
  work::Worth worth = whole(test.campaign);
  worth.add_if(!test.all_survived(), work::Grade::kMissed, "fell or faulted under a condition");
  return worth;
}

void evaluate(RobustnessTest& test) {
  test.summaries.clear();
  for (const auto& runs : test.campaign.runs) test.summaries.push_back(summarise(runs));
}

ordered_json to_json(const RobustnessTest& test) {
  ordered_json json = {{"kind", "robust"},
                       {"complete", test.campaign.complete},
                       {"robot", test.robot},
                       {"policy", test.cases.front().candidate.name},
                       {"scenario", test.scenario_file},
                       {"variation", test.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(test.ranges_file)},
                       {"seeds", test.seeds},
                       {"all_survived", test.all_survived()}};
  for (std::size_t c = 0; c < test.cases.size(); ++c) {
    ordered_json entry = {{"condition", test.cases[c].name}};
    entry.update(to_json(test.summaries[c], test.scenario));
    entry["survival"] = to_json(survival(test.summaries[c]));
    for (std::size_t seed = 0; seed < test.campaign.runs[c].size(); ++seed) {
      if (!test.campaign.runs[c][seed].complete) continue;
      ordered_json run = {{"seed", seed + 1}};
      run.update(to_json(test.campaign.runs[c][seed]));
      entry["runs"].push_back(run);
    }
    json["conditions"].push_back(entry);
  }
  return json;
}

std::vector<pages::Table> tables_of(const RobustnessTest& test) {
  pages::Table table{.header = error_columns("condition"), .rows = {}};
  table.header.insert(table.header.begin() + 1, "survived");
  for (std::size_t c = 0; c < test.cases.size(); ++c) {
    const CaseSummary& summary = test.summaries[c];
    std::vector<std::string> row = {test.cases[c].name, fmt::format("{} of {}", summary.survived, summary.trials)};
    for (const Estimate& error : summary.errors) row.push_back(interval_text(error));
    table.rows.push_back(row);
  }
  return {table};
}

pages::Page page_of(const RobustnessTest& test) {
  pages::Page page(fmt::format("Robustness: {} on {}", test.cases.front().candidate.name, test.robot));
  page.worth(worth_of(test));
  if (worth_of(test).usable()) page.verdict({}, "Walked the whole scenario under every condition, with every seed");
  page.heading("Conditions");
  pages::Bars bars{.title = "survived [%], 95 % interval", .unit = "%", .names = {}, .sets = {}};
  pages::Bars::Set set{.name = "survived", .values = {}};
  for (std::size_t c = 0; c < test.cases.size(); ++c) {
    const Estimate share = survival(test.summaries[c]);
    bars.names.push_back(test.cases[c].name);
    set.values.push_back(100.0 * share.mean);
    set.intervals.push_back({100.0 * share.lower, 100.0 * share.upper});
  }
  bars.sets = {set};
  page.bars(bars);
  for (const pages::Table& table : tables_of(test)) page.table(table);
  page.heading("How it was measured");
  page.paragraph(
      fmt::format("{} seeds a condition of {} ({:.0f} s). Besides the condition robots differ as {} says; the "
                  "first condition is what pmg_sil simulates, with different sensor noise a seed.",
                  test.seeds, test.scenario_file, test.scenario.duration_s(),
                  test.ranges_file.empty() ? "the model" : test.ranges_file));
  return page;
}

}  // namespace pmg::evaluation
