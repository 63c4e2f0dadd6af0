#include "command_response/jumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "evaluation/statistics.hpp"

namespace pmg::command_response {

namespace {

using evaluation::TrialResult;
using nlohmann::ordered_json;

constexpr double kStandBefore_s = 1.5;
constexpr double kRest_s = 3.0;  // a robot that is about to fall has fallen by then
constexpr std::array<const char*, 2> kGroupNames = {"velocities", "velocities and postures"};

bool postures_jump(std::uint64_t seed) { return seed % 2 == 0; }

/// Survivors of the seeds whose postures jump, or of the others.
evaluation::Estimate survival(const JumpTest& test, bool with_postures) {
  std::int64_t survived = 0, trials = 0;
  for (std::size_t i = 0; i < test.runs.size(); ++i) {
    if (!test.runs[i].complete || postures_jump(i + 1) != with_postures) continue;
    ++trials;
    survived += test.runs[i].survived() ? 1 : 0;
  }
  return evaluation::share_interval(survived, trials);
}

/// "fell after 12.3 s", a fault in words, or "survived".
std::string end_of(const TrialResult& run) {
  if (!run.faults.empty()) return run.faults.front();
  return run.fell ? fmt::format("fell after {:.1f} s", run.fell_at_s) : "survived";
}

std::string percent(const evaluation::Estimate& share) {
  return std::isnan(share.mean)
             ? "not tried"
             : fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100.0 * share.mean, 100.0 * share.lower, 100.0 * share.upper);
}

}  // namespace

sil::Scenario jump_scenario(const CommandLimits& limits, std::uint64_t seed, double duration_s) {
  std::mt19937_64 random(seed);
  sil::Scenario scenario{.name = "jumps", .steps = {}};
  double start_s = 0.0;
  const auto add = [&](double lasting_s, control::Mode mode, const char* text, const Command& command) {
    sil::ScenarioStep step;
    step.start_s = start_s;
    step.duration_s = lasting_s;
    step.text = text;
    step.mode = mode;
    step.command = command;
    scenario.steps.push_back(step);
    start_s += lasting_s;
  };
  add(kStandBefore_s, control::Mode::kStand, "stand", {});
  const std::size_t channels = postures_jump(seed) ? kChannels : kVelocityChannels;
  for (long jump = 0; jump < std::lround(duration_s / kJump_s); ++jump) {
    Command command;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::array<double, 3> ends = {limits.lower[c], 0.0, limits.upper[c]};
      command.u[c] = ends[(random() >> 11) % ends.size()];
    }
    add(kJump_s, control::Mode::kWalk, "jump", command);
  }
  add(kRest_s, control::Mode::kWalk, "rest", {});
  return scenario;
}

bool JumpTest::complete() const {
  return std::ranges::all_of(runs, [](const TrialResult& run) { return run.complete; });
}

work::Worth worth_of(const JumpTest& test) {
  work::Worth worth;
  worth.add_if(!test.complete(), work::Grade::kInterrupted, "not all robots ran to the end");
  worth.add_if(!test.all_survived(), work::Grade::kMissed, "a robot fell or faulted");
  return worth;
}

bool JumpTest::all_survived() const {
  return std::ranges::all_of(runs, [](const TrialResult& run) { return !run.complete || run.survived(); });
}

void run_jumps(JumpTest& test, const evaluation::Supervision& supervision) {
  const model::RobotModel robot = control::load_robot(test.evaluated.candidate.control);
  test.runs.assign(static_cast<std::size_t>(test.seeds), {});
  evaluation::for_each_piece(test.runs.size(), supervision, [&](std::size_t i) {
    const std::uint64_t seed = i + 1;
    test.runs[i] = evaluation::run_trial(
        test.evaluated.candidate, jump_scenario(robot.command_limits, seed, test.duration_s),
        test.evaluated.plants.of(robot, seed), {.gantry = false, .progress = supervision.progress, .observer = {}});
  });
}

ordered_json to_json(const JumpTest& test) {
  ordered_json json = {{"kind", "jumps"},
                       {"complete", test.complete()},
                       {"robot", test.robot},
                       {"policy", test.evaluated.name},
                       {"variation", test.ranges_file.empty() ? ordered_json(nullptr) : ordered_json(test.ranges_file)},
                       {"seeds", test.seeds},
                       {"duration_s", test.duration_s},
                       {"jump_s", kJump_s},
                       {"all_survived", test.all_survived()},
                       {"runs", ordered_json::array()}};
  for (std::size_t i = 0; i < test.runs.size(); ++i) {
    if (!test.runs[i].complete) continue;
    ordered_json run = {{"seed", i + 1}, {"postures_jump", postures_jump(i + 1)}};
    run.update(evaluation::to_json(test.runs[i]));
    json["runs"].push_back(run);
  }
  return json;
}

std::vector<pages::Table> tables_of(const JumpTest& test) {
  pages::Table groups{.header = {"jumping", "survived"}, .rows = {}};
  for (const bool with : {false, true})
    groups.rows.push_back({kGroupNames[with ? 1 : 0], percent(survival(test, with))});
  pages::Table runs{.header = evaluation::error_columns("seed"), .rows = {}};
  runs.header.insert(runs.header.begin() + 1, {"jumping", "end"});
  for (std::size_t i = 0; i < test.runs.size(); ++i) {
    if (!test.runs[i].complete) continue;
    std::vector<std::string> row = {std::to_string(i + 1), kGroupNames[postures_jump(i + 1) ? 1 : 0],
                                    end_of(test.runs[i])};
    for (const double error : test.runs[i].errors) row.push_back(fmt::format("{:.3f}", error));
    runs.rows.push_back(row);
  }
  return {groups, runs};
}

pages::Page page_of(const JumpTest& test) {
  pages::Page page(fmt::format("Jumping commands: {} on {}", test.evaluated.name, test.robot));
  page.worth(worth_of(test));
  if (worth_of(test).usable()) page.verdict({}, "No robot fell or faulted");
  page.heading("Robots");
  for (const pages::Table& table : tables_of(test)) page.table(table);
  page.heading("How it was measured");
  page.paragraph(fmt::format(
      "Every {} s for {:.0f} s each velocity goes to its lower end, its upper end or 0; with even seeds pitch, roll "
      "and height do, too. Then the robot rests for {:.0f} s. Each seed is another robot ({}) with another sequence. "
      "The commands' ramps lag behind such jumps, so the errors only describe the runs.",
      kJump_s, test.duration_s, kRest_s, test.ranges_file.empty() ? "as the model says" : test.ranges_file));
  return page;
}

}  // namespace pmg::command_response
