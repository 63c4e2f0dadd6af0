#include "teleoperation/table3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pmg::teleoperation {

namespace {

using nlohmann::ordered_json;

std::string percent(const evaluation::Estimate& share) {
  return fmt::format("{:.0f} [{:.0f}, {:.0f}]", 100.0 * share.mean, 100.0 * share.lower, 100.0 * share.upper);
}

}  // namespace

evaluation::Estimate Table3::wiped() const {
  const auto took_place = [](const WipingResult& run) { return run.end != End::kInterrupted; };
  return evaluation::share_interval(std::ranges::count(wiping, End::kDone, &WipingResult::end),
                                    std::ranges::count_if(wiping, took_place));
}

std::map<std::string, int> Table3::ends() const {
  std::map<std::string, int> ends;
  for (const WipingResult& run : wiping)
    if (run.end != End::kInterrupted) ++ends[end_name(run.end)];
  return ends;
}

bool Table3::reached() const { return wiped().mean >= kPaperWiping; }

work::Worth worth_of(const Table3& table) {
  work::Worth worth(work::Grade::kPartial, "box picking is not simulated yet");
  worth.add_if(!table.complete, work::Grade::kInterrupted, "not all trials ran");
  worth.add_if(table.complete && !table.reached(), work::Grade::kMissed,
               fmt::format("the towel is wiped in less than {:.0f} % of the trials", 100.0 * kPaperWiping));
  return worth;
}

void run_table3(Table3& table, const evaluation::Supervision& supervision) {
  const model::RobotModel robot = model::load_robot(model::find_robot(table.evaluated.candidate.control.robot));
  table.wiping.assign(static_cast<std::size_t>(table.trials), {});
  evaluation::for_each_piece(table.wiping.size(), supervision, [&](std::size_t trial) {
    table.wiping[trial] = run_wiping(table.evaluated.candidate, table.evaluated.plants.of(robot, trial + 1),
                                     WipingPlan::of(trial), supervision.progress);
  });
  table.complete = std::ranges::count(table.wiping, End::kInterrupted, &WipingResult::end) == 0;
}

ordered_json to_json(const Table3& table) {
  const evaluation::Estimate wiped = table.wiped();
  ordered_json json = {
      {"kind", "table3"},
      {"complete", table.complete},
      {"robot", table.robot},
      {"policy", table.evaluated.name},
      {"variation", table.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(table.ranges_file)},
      {"tasks", ordered_json::array()}};
  ordered_json task = {{"task", "wiping"},
                       {"trials", table.trials},
                       {"success", {{"share", wiped.mean}, {"ci95", {wiped.lower, wiped.upper}}}},
                       {"paper", kPaperWiping},
                       {"ends", table.ends()},
                       {"runs", ordered_json::array()}};
  for (std::size_t trial = 0; trial < table.wiping.size(); ++trial) {
    const WipingResult& run = table.wiping[trial];
    task["runs"].push_back({{"trial", trial},
                            {"end", end_name(run.end)},
                            {"moved_m", run.moved_m},
                            {"duration_s", run.duration_s},
                            {"stage", run.stage},
                            {"words", run.words}});
  }
  json["tasks"].push_back(task);
  return json;
}

pages::Page page_of(const Table3& table) {
  pages::Page page(fmt::format("Teleoperation: {} on {}", table.evaluated.name, table.robot));
  page.worth(worth_of(table));
  page.verdict(table.reached() ? work::Worth() : work::Worth(work::Grade::kMissed, "too few trials succeeded"),
               fmt::format("Wiping: done in {} % of trials; the paper has {:.0f} % of 20 on the real robot",
                           percent(table.wiped()), 100.0 * kPaperWiping));
  page.paragraph(fmt::format("Box picking: not simulated yet; the paper has {:.0f} %.", 100.0 * kPaperBoxPicking));
  page.heading("How trials ended");
  pages::Table ends{.header = {"end", "trials"}, .rows = {}};
  for (const auto& [name, count] : table.ends()) ends.rows.push_back({name, std::to_string(count)});
  page.table(ends);
  page.heading("Each trial");
  pages::Table runs{.header = {"trial", "end", "moved [m]", "after [s]", "what the operator did", "what it was told"},
                    .rows = {}};
  for (std::size_t trial = 0; trial < table.wiping.size(); ++trial) {
    const WipingResult& run = table.wiping[trial];
    runs.rows.push_back({std::to_string(trial), end_name(run.end), fmt::format("{:.2f}", run.moved_m),
                         fmt::format("{:.0f}", run.duration_s), run.stage, run.words});
  }
  page.table(runs);
  page.heading("How it was measured");
  page.paragraph(
      fmt::format("A scripted operator in a headset sends head and hands through the code behind pmg_web's socket; "
                  "nothing else moves "
                  "the robot ({}). It sees the towel, its palms and the table's edge as the head's camera shows them: "
                  "30 pictures a "
                  "second, 0.12 s late, places within 5 mm (standard deviation), and nothing outside the picture. "
                  "Done: the towel, a "
                  "stiff patch of {} kg, moved along the table by more than {} m within {:.0f} s and lay on it all the "
                  "time; the robot "
                  "stood. The table is {} m high, the towel's friction on it {}, the palm's on the towel 0.8. The "
                  "interval is Wilson's, "
                  "95 %.",
                  table.ranges_file.empty() ? "as the model says" : table.ranges_file, WipingPlan::kTowelMass_kg,
                  WipingPlan::kMoved_m, WipingPlan::kLongest_s, WipingPlan::kTableTop_m, WipingPlan::kTowelFriction));
  return page;
}

std::vector<std::string> text_of(const Table3& table) {
  std::vector<std::string> lines = {fmt::format("wiping: done in {} % of {} trials (the paper: {:.0f} %)",
                                                percent(table.wiped()), table.trials, 100.0 * kPaperWiping)};
  for (const auto& [name, count] : table.ends()) lines.push_back(fmt::format("  {}: {}", name, count));
  lines.push_back(fmt::format("box picking: not simulated yet (the paper: {:.0f} %)", 100.0 * kPaperBoxPicking));
  return lines;
}

}  // namespace pmg::teleoperation
