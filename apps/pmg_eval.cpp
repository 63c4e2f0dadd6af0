// pmg_eval: how well policies do, over many simulated robots in parallel.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "evaluation/table1.hpp"
#include "progress_line.hpp"
#include "runtime/summary.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kMissed = 1, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
Every subcommand runs the real controller in lockstep with MuJoCo, writes DIR/report.html (self-contained) and DIR/NAME.json
(docs/evaluation.md), and gives the same figures for the same seeds however many jobs run at once.

Example:
  pmg_eval table1 --robot z1 --seeds 20 --out out/table1
  pmg_eval table1 --policy pmg=trained/new.onnx --policy without_gco --seeds 4 --out out/new

Exit codes: 0 done and every limit reached, 1 done and a limit missed, 2 bad input or output, 130 interrupted (what was
done until then is written and marked incomplete).)";

struct Arguments {
  std::string robot = "z1";
  std::vector<std::string> policies;
  fs::path clips, out, scenario = "config/scenarios/table1.yaml", variation = "config/evaluation/variation.yaml";
  int seeds = 20, jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool gantry = false, nominal = false, json = false;
};

volatile std::sig_atomic_t interrupt_requested = 0;
void on_interrupt(int /*signal*/) { interrupt_requested = 1; }

void declare_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
  command.add_option("--clips", arguments.clips, "clip library; the robot's own clips/ if not given");
  command.add_option("--variation", arguments.variation, "ranges that simulated robots are drawn from (YAML)")
      ->capture_default_str();
  command
      .add_flag("--nominal", arguments.nominal, "robots as the model says instead; seeds differ in sensor noise alone")
      ->excludes("--variation");
  command.add_option("--jobs", arguments.jobs, "runs at once")->check(CLI::PositiveNumber)->capture_default_str();
  command.add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  command.add_flag("--json", arguments.json, "print the JSON on stdout instead of the short report");
}

/// NAME, FILE.onnx, or NAME=either: then shown as NAME.
evaluation::Candidate candidate(const std::string& text, const Arguments& arguments) {
  const std::size_t sign = text.find('=');
  const std::string policy = sign == std::string::npos ? text : text.substr(sign + 1);
  const std::string name = sign == std::string::npos ? fs::path(text).stem().string() : text.substr(0, sign);
  if (name.empty() || policy.empty())
    throw std::invalid_argument(fmt::format("--policy {}: expected NAME, FILE.onnx or NAME=FILE.onnx", text));
  return {name, {.robot = arguments.robot, .clips = arguments.clips, .policy = policy}};
}

/// Loads each once, so that what doesn't fit is told before hours of work.
std::vector<evaluation::Candidate> candidates(const Arguments& arguments) {
  std::vector<evaluation::Candidate> all;
  for (const std::string& text : arguments.policies) {
    all.push_back(candidate(text, arguments));
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i].name == all.back().name)
        throw std::invalid_argument(
            fmt::format("--policy {}: the name {} is taken; use NAME=FILE.onnx", text, all[i].name));
    }
    runtime::load_control(all.back().control);
  }
  return all;
}

evaluation::Plants plants(const Arguments& arguments) {
  evaluation::Plants plants;
  if (!arguments.nominal) plants.ranges = sim::load_variation_ranges(arguments.variation);
  return plants;
}

class Watch {
 public:
  explicit Watch(const Arguments& arguments) {
    supervision_.jobs = arguments.jobs;
    supervision_.interrupted = [] { return interrupt_requested != 0; };
    supervision_.progress = [this](std::size_t done, std::size_t count) { show(done, count); };
  }
  const evaluation::Supervision& supervision() const { return supervision_; }

 private:
  void show(std::size_t done, std::size_t count) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const double left_s = elapsed.count() / static_cast<double>(done) * static_cast<double>(count - done);
    line_.show(static_cast<double>(done) / static_cast<double>(count),
               fmt::format("{} of {} runs, {:.0f} s left", done, count, left_s));
  }
  evaluation::Supervision supervision_;
  apps::ProgressLine line_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Page and JSON to the folder, text or JSON to stdout.
void hand_over(const Arguments& arguments, const std::string& name, const nlohmann::ordered_json& json,
               const pages::Page& page, const std::vector<std::string>& text) {
  fs::create_directories(arguments.out);
  runtime::write_json(arguments.out / (name + ".json"), json);
  page.write(arguments.out / "report.html");
  if (arguments.json) {
    std::cout << json.dump(2) << '\n';
    return;
  }
  for (const std::string& line : text) std::cout << line << '\n';
  std::cout << "report in " << (arguments.out / "report.html").string() << '\n';
}

int table1(const Arguments& arguments) {
  evaluation::Table1 table;
  table.robot = arguments.robot;
  table.scenario_file = arguments.scenario.string();
  if (!arguments.nominal) table.ranges_file = arguments.variation.string();
  table.scenario = runtime::load_scenario(arguments.scenario);
  table.seeds = arguments.seeds;
  for (const evaluation::Candidate& c : candidates(arguments))
    table.cases.push_back({.name = c.name, .candidate = c, .plants = plants(arguments)});
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  for (int seed = 1; seed <= table.seeds; ++seed)
    table.plants.push_back(evaluation::plant_json(table.cases.front().plants.of(robot, static_cast<unsigned>(seed))));
  fs::create_directories(arguments.out);
  {
    const Watch watch(arguments);
    table.campaign =
        evaluation::run_campaign(table.cases, table.scenario, table.seeds, arguments.gantry, watch.supervision());
  }
  evaluation::evaluate(table);
  hand_over(arguments, "table1", to_json(table), page_of(table), text_of(table));
  if (!table.campaign.complete) return kInterrupted;
  return table.all_reached() ? kOk : kMissed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Evaluates policies over many simulated robots.", "pmg_eval");
  app.footer(kFooter);
  app.require_subcommand(1);
  Arguments arguments;
  CLI::App* table1_command =
      app.add_subcommand("table1", "Errors of policies over the same commands: the paper's Table I");
  declare_common(*table1_command, arguments);
  table1_command
      ->add_option("--policy", arguments.policies,
                   "policy's name below the robot's policies/, a file, or NAME=FILE; may be given several times")
      ->default_str("pmg without_gco single_gait");
  table1_command->add_option("--scenario", arguments.scenario, "commands (YAML)")->capture_default_str();
  table1_command->add_option("--seeds", arguments.seeds, "simulated robots")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  table1_command->add_flag("--gantry", arguments.gantry, "hang the robot in a gantry: nothing is judged");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kBadInput;
  }
  std::signal(SIGINT, on_interrupt);
  try {
    if (arguments.policies.empty()) arguments.policies = {"pmg", "without_gco", "single_gait"};
    return table1(arguments);
  } catch (const std::exception& error) {
    std::cerr << "pmg_eval: " << error.what() << '\n';
    return kBadInput;
  }
}
