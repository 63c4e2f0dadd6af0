#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "evaluation/table2.hpp"

namespace pmg::evaluation {

namespace {

using nlohmann::ordered_json;

constexpr const char* kOnePolicy =
    "The paper trains a policy for each configuration. Here one policy walks in all four, so what differs is the "
    "simulation and the robot, not what a policy has "
    "learned: imitation by a policy that was trained with the calibrated motors could be better.";

/// No bars beside ours: what can't be compared in size must not look as if it could.
constexpr const char* kOtherRobotAndPolicies =
    "The paper's figures are of its own robot and of four policies: compare the order and the ratio, not the sizes.";

/// (estimate over some of so many robots) => "0.0518 +-0.0078", "0.0518 +-0.0078 (4 of 10 robots)", "not measured"
std::string error_text(const Estimate& estimate, const ConfigurationResult& of) {
  if (!of.measured()) return "not measured";
  std::string text = interval_text(estimate);
  if (of.robots_without_errors > 0)
    text += fmt::format(" ({} of {} robots)", of.imitation_of_plant_rad.size(), of.robots());
  return text;
}

std::string ratio_text(const Table2& table) {
  return std::isfinite(table.ratio()) ? fmt::format("{:.2f}", table.ratio()) : "not measured";
}

/// What is measured, in numbers; what of it isn't as asked stands in the page's first line.
std::string what_calibration_leaves(const Table2& table) {
  const ConfigurationResult &before = table.results[kBaseline], &after = table.results[kFullCalibration];
  if (!std::isfinite(table.ratio()))
    return "How much error calibration leaves isn't known: robots fell before there was a step to compare.";
  const std::size_t robots = std::min(before.imitation_of_plant_rad.size(), after.imitation_of_plant_rad.size());
  return fmt::format(
      "A simulation's joints are {:.1f} mrad off its robot's before calibration, {:.1f} mrad after motors and zero "
      "points are calibrated: {:.2f} of it (asked: {:.2f} at most), on {} of {} robots.",
      1e3 * before.sim_to_real_rad.mean, 1e3 * after.sim_to_real_rad.mean, table.ratio(), kAskedRatio, robots,
      std::max(before.robots(), after.robots()));
}

std::string applied_zero_points(const Table2& table) {
  const ZeroPoints zeros = zero_points(table.plants);
  const std::size_t applied = zeros.well + zeros.roughly;
  std::string text =
      fmt::format("Of {} zero points {} were applied: {} known well, {} roughly ({:.0f} %).", applied + zeros.untold,
                  applied, zeros.well, zeros.roughly,
                  applied == 0 ? 0.0 : 100.0 * static_cast<double>(zeros.roughly) / static_cast<double>(applied));
  if (zeros.untold > 0) text += fmt::format(" {} couldn't be told and stay as they are.", zeros.untold);
  return text + fmt::format(" The worst is {:.0f} mrad off afterwards.", 1e3 * zeros.worst_left_rad);
}

pages::Bars bars(const Table2& table, std::size_t metric, const std::string& title) {
  pages::Bars picture{.title = title, .unit = "rad", .names = {}, .sets = {{.name = "measured", .values = {}}}};
  for (std::size_t c = 0; c < kConfigurations; ++c) {
    const ConfigurationResult& r = table.results[c];
    if (!r.measured()) continue;
    const Estimate& e = metric == 0 ? r.imitation_rad : r.sim_to_real_rad;
    picture.names.push_back(kConfigurationNames[c]);
    picture.sets[0].values.push_back(e.mean);
    picture.sets[0].intervals.push_back({e.lower, e.upper});
  }
  return picture;
}

}  // namespace

ordered_json to_json(const Table2& table) {
  ordered_json json = {{"kind", "table2"},
                       {"complete", table.complete},
                       {"robot", table.robot},
                       {"policy", table.policy},
                       {"plants_file", table.plants_file},
                       {"scenario", table.scenario_file},
                       {"policies_trained", 1},
                       {"joints", table.joints},
                       {"configurations", ordered_json::array()},
                       {"plants", ordered_json::array()}};
  if (table.complete) {
    json["limits"] = {{"ratio", table.ratio()}, {"limit", kAskedRatio}, {"all_reached", table.all_reached()}};
    for (std::size_t c = 0; c < kConfigurations; ++c) {
      const ConfigurationResult& r = table.results[c];
      const auto paper = published(static_cast<Configuration>(c));
      json["configurations"].push_back({{"name", kConfigurationNames[c]},
                                        {"imitation_rad", to_json(r.imitation_rad)},
                                        {"sim_to_real_rad", to_json(r.sim_to_real_rad)},
                                        {"paper", {{"imitation_rad", paper[0]}, {"sim_to_real_rad", paper[1]}}},
                                        {"imitation_of_plants_rad", r.imitation_of_plant_rad},
                                        {"sim_to_real_of_plants_rad", r.sim_to_real_of_plant_rad},
                                        {"robots_without_errors", r.robots_without_errors},
                                        {"robot_falls", r.robot_falls},
                                        {"simulation_falls", r.simulation_falls}});
    }
  }
  for (const CalibratedPlant& plant : table.plants) {
    const ZeroPoints zeros = zero_points({plant});
    ordered_json offsets = ordered_json::object();
    for (const FoundOffset& found : plant.offsets) offsets[found.joint] = found.zero_offset_rad;
    json["plants"].push_back(
        {{"truth", sim::motor_yaml(plant.truth)},
         {"calibrated_motors", sim::motor_yaml(plant.motors)},
         {"calibrated_zero_offsets_rad", offsets},
         {"zero_points", {{"well", zeros.well}, {"roughly", zeros.roughly}, {"untold", zeros.untold}}},
         {"worst_offset_left_rad", plant.worst_offset_rad}});
  }
  return json;
}

std::vector<pages::Table> tables_of(const Table2& table) {
  if (!table.complete) return {};
  pages::Table figures{.header = {"configuration", "imitation [rad]", "paper (other robot)", "sim-to-real [rad]",
                                  "paper (other robot)", "robots that fell", "simulations that fell"},
                       .rows = {}};
  for (std::size_t c = 0; c < kConfigurations; ++c) {
    const ConfigurationResult& r = table.results[c];
    const auto paper = published(static_cast<Configuration>(c));
    figures.rows.push_back({kConfigurationNames[c], error_text(r.imitation_rad, r), fmt::format("{:.4f}", paper[0]),
                            error_text(r.sim_to_real_rad, r), fmt::format("{:.4f}", paper[1]),
                            fmt::format("{} of {}", r.robot_falls, table.plants.size()),
                            fmt::format("{}", r.simulation_falls)});
  }
  pages::Table ratio{.header = {"sim-to-real error of full calibration over the baseline's", "asked"}, .rows = {}};
  ratio.rows.push_back({ratio_text(table), fmt::format("{}", kAskedRatio)});
  return {figures, ratio};
}

pages::Page page_of(const Table2& table) {
  pages::Page page(fmt::format("{}: sim-to-real, Table II", table.robot));
  page.worth(worth_of(table));
  if (!table.complete) return page;
  page.verdict({}, what_calibration_leaves(table));
  page.verdict({}, applied_zero_points(table));
  page.paragraph(kOnePolicy);
  page.heading("Errors");
  page.paragraph("Means over robots, with their 95 % intervals.");
  page.columns([&] {
    page.bars(bars(table, 0, "motion imitation error [rad]"));
    page.bars(bars(table, 1, "sim-to-real error [rad]"));
  });
  page.paragraph(kOtherRobotAndPolicies);
  for (const pages::Table& one : tables_of(table)) page.table(one);
  page.heading("A knee, robot 1");
  std::vector<double> phase;
  for (std::size_t bin = 0; bin < WalkCurves::kBins; ++bin)
    phase.push_back((static_cast<double>(bin) + 0.5) / static_cast<double>(WalkCurves::kBins));
  const auto has_samples = [](const std::vector<double>& curve) {
    return std::ranges::any_of(curve, [](double q) { return std::isfinite(q); });
  };
  for (std::size_t c = 0; c < kConfigurations; ++c) {
    if (!has_samples(table.shown_robot[c])) {
      page.paragraph(fmt::format("{}: robot 1 fell before it had walked; there is no curve.", kConfigurationNames[c]));
      continue;
    }
    page.chart(
        {.title = fmt::format("{}: {} over the gait cycle [rad]", kConfigurationNames[c],
                              table.joints.size() > 3 ? table.joints[3] : ""),
         .x_name = "phase",
         .x_unit = "",
         .lines =
             {{.name = "robot", .x = phase, .y = table.shown_robot[c], .colour = pages::colour::kInk},
              {.name = "simulation", .x = phase, .y = table.shown_simulation[c], .colour = pages::colour::kVermillion}},
         .height_px = 170});
  }
  page.heading("Calibration");
  pages::Table plants{.header = {"robot", "zero points known well", "roughly", "not told", "worst offset left [mrad]"},
                      .rows = {}};
  for (std::size_t k = 0; k < table.plants.size(); ++k) {
    const ZeroPoints zeros = zero_points({table.plants[k]});
    plants.rows.push_back({std::to_string(k + 1), std::to_string(zeros.well), std::to_string(zeros.roughly),
                           std::to_string(zeros.untold),
                           fmt::format("{:.2f}", 1e3 * table.plants[k].worst_offset_rad)});
  }
  page.table(plants);
  return page;
}

}  // namespace pmg::evaluation
