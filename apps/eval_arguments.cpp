#include "eval_arguments.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "option_checks.hpp"
#include "result_folder.hpp"

namespace pmg::apps {
namespace {

constexpr const char* kTable1Scenario = "table1_full";
constexpr const char* kTable2Scenario = "table2";
constexpr const char* kRobustScenario = "tour";

constexpr const char* kFooter = R"(
Each runs the real controller in lockstep with MuJoCo, writes DIR/report.html (self-contained) and DIR/COMMAND.json
(docs/how-to/evaluation.md), and gives the same figures for the same seeds however many jobs run at once.

Examples:
  pmg_eval table1 --robot z1 --seeds 20 --out out/table1
  pmg_eval table1 --policy pmg=trained/new.onnx --policy without_gco --seeds 4 --out out/new
  pmg_eval table2 --robot z1 --policy pmg --out out/table2
  pmg_eval table3 --trials 100 --out out/table3
  pmg_eval table3 --first 58 --trials 1 --video --out out/trial_58
  pmg_eval push --trials 200 --out out/push
  pmg_eval robust --seeds 20 --out out/robust
  pmg_eval gait --out out/gait
  pmg_eval steady --out out/steady
  pmg_eval jumps --seeds 20 --out out/jumps

Exit codes: 0 done and every limit reached, 1 done and a limit missed, 2 bad input or output (a film that fails leaves the rest
whole), 130 interrupted (what was done until then is written and marked incomplete).)";

void declare_robot(CLI::App& command, EvalArguments& arguments) {
  command.add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
}

void declare_clips(CLI::App& command, EvalArguments& arguments) {
  command.add_option("--clips", arguments.clips, "clip library; the policy's own, or the robot's clips/, if not given");
}

void declare_output(CLI::App& command, EvalArguments& arguments) {
  command.add_option("--jobs", arguments.jobs, "runs at once")->check(in_range(1, 1024))->default_str("one a core");
  command.add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  add_overwrite(command, arguments.overwrite);
  command.add_flag("--json", arguments.json, "print the JSON on stdout instead of the short report");
}

void declare_common(CLI::App& command, EvalArguments& arguments) {
  declare_robot(command, arguments);
  declare_clips(command, arguments);
  CLI::Option* variation =
      command
          .add_option("--variation", arguments.variation,
                      "ranges that simulated robots are drawn from: a name in config/evaluation, or a file (YAML)")
          ->capture_default_str();
  command.add_flag("--nominal", arguments.nominal, "robots as the model says; seeds differ in sensor noise alone")
      ->excludes(variation);
  declare_output(command, arguments);
}

constexpr const char* kPolicyHelp =
    "policy's name below the robot's policies/, a file, or NAME=either; none: no policy";

void declare_policy(CLI::App& command, EvalArguments& arguments) {
  command.add_option("--policy", arguments.policies, kPolicyHelp)->expected(1)->default_str("pmg");
}

void declare_seeds(CLI::App& command, EvalArguments& arguments) {
  command.add_option("--seeds", arguments.seeds, "simulated robots")->check(in_range(1, 100000))->capture_default_str();
}

void declare_scenario_file(CLI::App& command, EvalArguments& arguments, const char* scenario) {
  command.add_option("--scenario", arguments.scenario, "commands: a name in config/scenarios, or a file (YAML)")
      ->default_str(scenario);
}

void declare_scenario(CLI::App& command, EvalArguments& arguments, const char* scenario) {
  declare_scenario_file(command, arguments, scenario);
  declare_seeds(command, arguments);
}

void declare_table1(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("table1", "Errors of policies over the same commands: Table I of the paper");
  declare_common(command, arguments);
  declare_scenario(command, arguments, kTable1Scenario);
  command.add_option("--policy", arguments.policies, std::string(kPolicyHelp) + "; may be given several times")
      ->default_str("pmg without_gco single_gait");
  command.add_flag("--video", arguments.video, "film each policy with seed 1 (needs ffmpeg; minutes each)");
  command.add_flag("--gantry", arguments.gantry, "hang the robot in a gantry: nothing is judged");
}

void declare_table2(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "table2", "How far simulations are from robots with hidden actuators, by calibration: Table II of the paper");
  declare_robot(command, arguments);
  declare_policy(command, arguments);
  declare_scenario_file(command, arguments, kTable2Scenario);
  command
      .add_option("--plants", arguments.plants,
                  "what the robots' actuators are drawn from: a name in config/evaluation, or a file (YAML)")
      ->capture_default_str();
  declare_output(command, arguments);
}

void declare_table3(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "table3", "How often an operator in a headset wipes a table and moves a box: Table III of the paper");
  declare_common(command, arguments);
  declare_policy(command, arguments);
  command.add_option("--trials", arguments.tasks, "trials of each task, each with another robot and other places")
      ->check(in_range(1, 100000))
      ->capture_default_str();
  command.add_option("--first", arguments.first, "number of the first trial; a trial is the same in every evaluation")
      ->check(in_range(0, 1000000))
      ->capture_default_str();
  command.add_flag("--video", arguments.video,
                   "film of each task the first trial of each end, done or not (needs ffmpeg; minutes each)");
}

void declare_push(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("push", "Impulses at the torso: how many are survived");
  declare_common(command, arguments);
  declare_policy(command, arguments);
  command.add_option("--strengths", arguments.strengths_N_s, "impulses [N s], separated by commas")
      ->delimiter(',')
      ->check(in_range(0.0, 1000.0))
      ->default_str("0,10,20,30,35,40,50");
  command
      .add_option("--trials", arguments.trials, "pushes of each strength; 16 are every direction, standing and walking")
      ->check(in_range(1, 100000))
      ->capture_default_str();
}

void declare_robust(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("robust", "The tour with payload, little and much friction, and delay");
  declare_common(command, arguments);
  declare_policy(command, arguments);
  declare_scenario(command, arguments, kRobustScenario);
}

void declare_gait(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("gait", "Steady walking beside published means of human gait");
  declare_common(command, arguments);
  declare_policy(command, arguments);
  command.add_option("--norms", arguments.norms,
                     "CSV of published means (docs/how-to/evaluation.md); a built-in set if not given");
  command.add_option("--speed", arguments.speed_m_s, "forward [m/s]")->check(positive())->capture_default_str();
}

void declare_steady(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("steady",
                                          "What share of a held command is realised: single velocities, "
                                          "pairs at 80 %, all three at 60 % and single ones at 20 % of their ranges");
  declare_robot(command, arguments);
  declare_clips(command, arguments);
  declare_policy(command, arguments);
  declare_output(command, arguments);
}

void declare_jumps(CLI::App& app, EvalArguments& arguments) {
  CLI::App& command = *app.add_subcommand("jumps", "Commands that jump between their ends every half second");
  declare_common(command, arguments);
  declare_policy(command, arguments);
  declare_seeds(command, arguments);
  command.add_option("--duration", arguments.duration_s, "of jumping [s]")
      ->check(in_range(1.0, 3600.0))
      ->capture_default_str();
}

const Results kResults = {"an evaluation",
                          {"report.html", "table1.json", "table2.json", "table3.json", "push.json", "robust.json",
                           "gait.json", "steady.json", "jumps.json"}};

/// The films that an earlier evaluation's JSON names.
std::vector<std::filesystem::path> earlier_films(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> films;
  for (const std::string& name : kResults.names) {
    std::ifstream file(folder / name);
    if (!file || std::filesystem::path(name).extension() != ".json") continue;
    const auto json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object() || !json.contains("films") || !json["films"].is_array()) continue;
    for (const auto& film : json["films"]) {
      const std::filesystem::path path = film.is_string() ? film.get<std::string>() : "";
      if (path == path.filename() && path.extension() == ".mp4") films.push_back(folder / path);
    }
  }
  return films;
}

}  // namespace

void EvalArguments::make_folder() const {
  const std::vector<std::filesystem::path> films = earlier_films(out);
  make_result_folder(out, kResults, overwrite);
  for (const std::filesystem::path& film : films) std::filesystem::remove(film);
}

void EvalArguments::declare(CLI::App& app) {
  app.footer(kFooter);
  app.require_subcommand(1);
  declare_table1(app, *this);
  declare_table2(app, *this);
  declare_table3(app, *this);
  declare_push(app, *this);
  declare_robust(app, *this);
  declare_gait(app, *this);
  declare_steady(app, *this);
  declare_jumps(app, *this);
}

std::string EvalArguments::finish(const CLI::App& app) {
  const CLI::App& command = *app.get_subcommands().front();
  const std::string name = command.get_name();
  if (policies.empty()) policies = {"pmg"};
  if (name == "table1" && command.count("--policy") == 0) policies = {"pmg", "without_gco", "single_gait"};
  if (scenario.empty()) {
    scenario = name == "table1" ? kTable1Scenario : name == "table2" ? kTable2Scenario : kRobustScenario;
  }
  return name;
}

}  // namespace pmg::apps
