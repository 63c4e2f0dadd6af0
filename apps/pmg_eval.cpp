// pmg_eval: how well policies do, over many simulated robots in parallel.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "evaluation/gait.hpp"
#include "evaluation/push.hpp"
#include "evaluation/robustness.hpp"
#include "evaluation/table1.hpp"
#include "evaluation/table2.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "progress_line.hpp"
#include "sil/summary.hpp"
#include "sim/video_writer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kMissed = 1, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
Each runs the real controller in lockstep with MuJoCo, writes DIR/report.html (self-contained) and DIR/COMMAND.json
(docs/how-to/evaluation.md), and gives the same figures for the same seeds however many jobs run at once.

Examples:
  pmg_eval table1 --robot z1 --seeds 20 --out out/table1
  pmg_eval table1 --policy pmg=trained/new.onnx --policy without_gco --seeds 4 --out out/new
  pmg_eval table2 --robot z1 --policy pmg --out out/table2
  pmg_eval push --trials 200 --out out/push
  pmg_eval robust --seeds 20 --out out/robust
  pmg_eval gait --out out/gait

Exit codes: 0 done and every limit reached, 1 done and a limit missed, 2 bad input or output (a film that fails leaves the rest
whole), 130 interrupted (what was done until then is written and marked incomplete).)";

struct Arguments {
  std::string robot = "z1";
  std::vector<std::string> policies;
  fs::path clips, out, scenario, variation = "config/evaluation/variation.yaml", norms,
                                 plants = "config/evaluation/table2.yaml";
  std::vector<double> strengths_N_s = {0.0, 10.0, 20.0, 30.0, 35.0, 40.0, 50.0};
  int seeds = 20, trials = 200, jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  double speed_m_s = 0.8;
  bool gantry = false, nominal = false, video = false, json = false;

  std::string ranges_file() const { return nominal ? "" : variation.string(); }
};

void declare_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
  command.add_option("--clips", arguments.clips, "clip library; the robot's own clips/ if not given");
  CLI::Option* variation =
      command.add_option("--variation", arguments.variation, "ranges that simulated robots are drawn from (YAML)")
          ->capture_default_str();
  command.add_flag("--nominal", arguments.nominal, "robots as the model says; seeds differ in sensor noise alone")
      ->excludes(variation);
  command.add_option("--jobs", arguments.jobs, "runs at once")->check(apps::in_range(1, 1024))->capture_default_str();
  command.add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  command.add_flag("--json", arguments.json, "print the JSON on stdout instead of the short report");
}

constexpr const char* kPolicyHelp =
    "policy's name below the robot's policies/, a file, or NAME=either; none: no policy";

void declare_policy(CLI::App& command, Arguments& arguments) {
  command.add_option("--policy", arguments.policies, kPolicyHelp)->expected(1)->default_str("pmg");
}

void declare_seeds(CLI::App& command, Arguments& arguments, const char* scenario) {
  command.add_option("--scenario", arguments.scenario, "commands (YAML)")->default_str(scenario);
  command.add_option("--seeds", arguments.seeds, "simulated robots")
      ->check(apps::in_range(1, 100000))
      ->capture_default_str();
}

evaluation::Candidate candidate(const std::string& text, const Arguments& arguments) {
  const std::size_t sign = text.find('=');
  const std::string policy = sign == std::string::npos ? text : text.substr(sign + 1);
  const std::string name = sign == std::string::npos ? fs::path(text).stem().string() : text.substr(0, sign);
  if (name.empty() || policy.empty())
    throw std::invalid_argument(fmt::format("--policy {}: expected NAME, FILE.onnx or NAME=FILE.onnx", text));
  evaluation::Candidate candidate{name, {}};
  candidate.control.robot = arguments.robot;
  candidate.control.clips = arguments.clips;
  candidate.control.policy = policy;
  control::load_control(candidate.control);  // what doesn't fit is told before hours of work
  return candidate;
}

std::vector<evaluation::Candidate> candidates(const Arguments& arguments) {
  std::vector<evaluation::Candidate> all;
  for (const std::string& text : arguments.policies) {
    all.push_back(candidate(text, arguments));
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i].name == all.back().name)
        throw std::invalid_argument(
            fmt::format("--policy {}: there is a {} already; expected another NAME=FILE.onnx", text, all[i].name));
    }
  }
  return all;
}

evaluation::Plants plants(const Arguments& arguments) {
  evaluation::Plants plants;
  if (!arguments.nominal) plants.ranges = sim::load_variation_ranges(arguments.variation);
  return plants;
}

/// Shows how far the work is, while it lives.
class Watch {
 public:
  explicit Watch(const Arguments& arguments) {
    supervision_.jobs = arguments.jobs;
    supervision_.progress = {.told = [this](double share, std::string_view pieces) { show(share, pieces); },
                             .interrupted = [] { return apps::interrupt_requested != 0; }};
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch() = default;
  const evaluation::Supervision& supervision() const { return supervision_; }

 private:
  void show(double share, std::string_view pieces) {
    if (share == 0.0) return line_.show(0.0, pieces);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    line_.show(share, fmt::format("{}, {:.0f} s left", pieces, elapsed.count() * (1.0 - share) / share));
  }
  evaluation::Supervision supervision_;
  apps::ProgressLine line_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Page and JSON to the folder, text or JSON to stdout; the exit code.
template <typename Result>
int hand_over(const Arguments& arguments, const Result& result, bool complete, bool reached) {
  const nlohmann::ordered_json json = to_json(result);
  fs::create_directories(arguments.out);
  sil::write_json(arguments.out / (json["kind"].get<std::string>() + ".json"), json);
  page_of(result).write(arguments.out / "report.html");
  if (arguments.json) {
    std::cout << json.dump(2) << '\n';
  } else {
    for (const std::string& line : text_of(result)) std::cout << line << '\n';
    std::cout << "report in " << (arguments.out / "report.html").string() << '\n';
  }
  if (!complete) return kInterrupted;
  return reached ? kOk : kMissed;
}

/// What went wrong with films, a line each. The table's films are those that can be watched.
std::vector<std::string> make_films(const Arguments& arguments, evaluation::Table1& table) {
  const Watch watch(arguments);
  std::vector<std::optional<std::string>> failures(table.cases.size());  // nothing: not begun
  evaluation::for_each_piece(table.cases.size(), watch.supervision(), [&](std::size_t c) {
    failures[c] =
        film_case(table.cases[c], table.scenario, arguments.out / (table.cases[c].name + ".mp4"), watch.supervision());
  });
  std::vector<std::string> lines;
  for (std::size_t c = 0; c < failures.size(); ++c) {
    if (!failures[c]) continue;
    if (failures[c]->empty()) {
      table.films.push_back(table.cases[c].name + ".mp4");
    } else {
      lines.push_back(*failures[c]);
    }
  }
  return lines;
}

int table1(const Arguments& arguments) {
  evaluation::Table1 table;
  table.robot = arguments.robot;
  table.scenario_file = arguments.scenario.string();
  table.ranges_file = arguments.ranges_file();
  table.scenario = sil::load_scenario(arguments.scenario);
  table.seeds = arguments.seeds;
  for (const evaluation::Candidate& c : candidates(arguments))
    table.cases.push_back({.name = c.name, .candidate = c, .plants = plants(arguments)});
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  for (int seed = 1; seed <= table.seeds; ++seed)
    table.plants.push_back(table.cases.front().plants.of(robot, static_cast<std::uint64_t>(seed)));
  if (arguments.video) sim::expect_ffmpeg();
  fs::create_directories(arguments.out);
  table.campaign = evaluation::run_campaign(table.cases, table.scenario, table.seeds, arguments.gantry,
                                            Watch(arguments).supervision());
  measure_yardsticks(table, Watch(arguments).supervision());
  std::vector<std::string> failures;
  if (arguments.video && table.campaign.complete) failures = make_films(arguments, table);
  evaluate(table);
  const int code = hand_over(arguments, table, table.campaign.complete, table.all_reached());
  for (const std::string& failure : failures) std::cerr << "pmg_eval: " << failure << '\n';
  if (apps::interrupt_requested != 0) return kInterrupted;
  return failures.empty() ? code : static_cast<int>(kBadInput);
}

int table2(const Arguments& arguments) {
  evaluation::Table2 table;
  table.robot = arguments.robot;
  table.policy = candidate(arguments.policies.front(), arguments).control.policy;
  table.plants_file = arguments.plants.string();
  table.scenario_file = arguments.scenario.string();
  table.ranges = evaluation::load_plant_ranges(arguments.plants);
  table.scenario = sil::load_scenario(arguments.scenario);
  fs::create_directories(arguments.out);
  run_table2(table, arguments.out, Watch(arguments).supervision());
  return hand_over(arguments, table, table.complete, table.complete && table.all_reached());
}

int push(const Arguments& arguments) {
  evaluation::PushTest test;
  test.robot = arguments.robot;
  test.ranges_file = arguments.ranges_file();
  test.trials = arguments.trials;
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  test.evaluated = {.name = c.name, .candidate = c, .plants = plants(arguments)};
  fs::create_directories(arguments.out);
  run_pushes(test, arguments.strengths_N_s, Watch(arguments).supervision());
  return hand_over(arguments, test, test.complete, test.reached().value_or(true));
}

int robust(const Arguments& arguments) {
  evaluation::RobustnessTest test;
  test.robot = arguments.robot;
  test.scenario_file = arguments.scenario.string();
  test.ranges_file = arguments.ranges_file();
  test.scenario = sil::load_scenario(arguments.scenario);
  test.seeds = arguments.seeds;
  test.cases = evaluation::robustness_cases(candidate(arguments.policies.front(), arguments), plants(arguments));
  fs::create_directories(arguments.out);
  test.campaign =
      evaluation::run_campaign(test.cases, test.scenario, test.seeds, false, Watch(arguments).supervision());
  evaluate(test);
  return hand_over(arguments, test, test.campaign.complete, test.all_survived());
}

int gait(const Arguments& arguments) {
  evaluation::GaitTest test;
  test.robot = arguments.robot;
  test.speed_m_s = arguments.speed_m_s;
  test.norms = arguments.norms.empty() ? evaluation::built_in_norms() : evaluation::load_norms(arguments.norms);
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  test.evaluated = {.name = c.name, .candidate = c, .plants = {}};
  fs::create_directories(arguments.out);
  run_gait(test, Watch(arguments).supervision());
  return hand_over(arguments, test, test.trial.complete, test.reached());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Evaluates policies over many simulated robots.", "pmg_eval");
  app.footer(kFooter);
  app.require_subcommand(1);
  Arguments arguments;
  CLI::App* table1_command =
      app.add_subcommand("table1", "Errors of policies over the same commands: Table I of the paper");
  declare_common(*table1_command, arguments);
  declare_seeds(*table1_command, arguments, "config/scenarios/table1_full.yaml");
  table1_command->add_option("--policy", arguments.policies, std::string(kPolicyHelp) + "; may be given several times")
      ->default_str("pmg without_gco single_gait");
  table1_command->add_flag("--video", arguments.video, "film each policy with seed 1 (needs ffmpeg; minutes each)");
  table1_command->add_flag("--gantry", arguments.gantry, "hang the robot in a gantry: nothing is judged");
  CLI::App* table2_command = app.add_subcommand(
      "table2", "How far simulations are from robots with hidden actuators, by calibration: Table II of the paper");
  table2_command->add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
  declare_policy(*table2_command, arguments);
  table2_command->add_option("--scenario", arguments.scenario, "commands (YAML)")
      ->default_str("config/scenarios/table2.yaml");
  table2_command->add_option("--plants", arguments.plants, "what the robots' actuators are drawn from (YAML)")
      ->capture_default_str();
  table2_command->add_option("--jobs", arguments.jobs, "runs at once")
      ->check(apps::in_range(1, 1024))
      ->capture_default_str();
  table2_command->add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  table2_command->add_flag("--json", arguments.json, "print the JSON on stdout instead of the short report");
  CLI::App* push_command = app.add_subcommand("push", "Impulses at the torso: how many are survived");
  declare_common(*push_command, arguments);
  declare_policy(*push_command, arguments);
  push_command->add_option("--strengths", arguments.strengths_N_s, "impulses [N s], separated by commas")
      ->delimiter(',')
      ->check(apps::in_range(0.0, 1000.0))
      ->default_str("0,10,20,30,35,40,50");
  push_command
      ->add_option("--trials", arguments.trials,
                   "pushes of each strength; 16 are every direction, standing and walking")
      ->check(apps::in_range(1, 100000))
      ->capture_default_str();
  CLI::App* robust_command = app.add_subcommand("robust", "The tour with payload, little and much friction, and delay");
  declare_common(*robust_command, arguments);
  declare_policy(*robust_command, arguments);
  declare_seeds(*robust_command, arguments, "config/scenarios/tour.yaml");
  CLI::App* gait_command = app.add_subcommand("gait", "Steady walking beside published means of human gait");
  declare_common(*gait_command, arguments);
  declare_policy(*gait_command, arguments);
  gait_command->add_option("--norms", arguments.norms,
                           "CSV of published means (docs/how-to/evaluation.md); a built-in set if not given");
  gait_command->add_option("--speed", arguments.speed_m_s, "forward [m/s]")
      ->check(apps::positive())
      ->capture_default_str();
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "ending the runs under way, then the report of what is complete");
    const bool compares = table1_command->parsed();
    if (arguments.policies.empty()) arguments.policies = {"pmg"};
    if (compares && table1_command->count("--policy") == 0) arguments.policies = {"pmg", "without_gco", "single_gait"};
    if (arguments.scenario.empty())
      arguments.scenario = table2_command->parsed() ? "config/scenarios/table2.yaml"
                           : compares               ? "config/scenarios/table1_full.yaml"
                                                    : "config/scenarios/tour.yaml";
    if (compares) return table1(arguments);
    if (table2_command->parsed()) return table2(arguments);
    if (push_command->parsed()) return push(arguments);
    if (robust_command->parsed()) return robust(arguments);
    return gait(arguments);
  });
}
