// pmg_eval: performance of policies over many simulated robots in parallel.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "command_response/jumps.hpp"
#include "command_response/steady.hpp"
#include "eval_arguments.hpp"
#include "evaluation/gait.hpp"
#include "evaluation/push.hpp"
#include "evaluation/robustness.hpp"
#include "evaluation/table1.hpp"
#include "evaluation/table2.hpp"
#include "files/config_folders.hpp"
#include "json_output.hpp"
#include "pages/text.hpp"
#include "program.hpp"
#include "progress_line.hpp"
#include "sil/summary.hpp"
#include "sim/video_writer.hpp"
#include "teleoperation/table3.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kBadInput = 2, kInterrupted = 130 };

evaluation::Candidate candidate(const std::string& text, const apps::EvalArguments& arguments) {
  const std::size_t sign = text.find('=');
  const std::string policy = sign == std::string::npos ? text : text.substr(sign + 1);
  const std::string name = sign == std::string::npos ? fs::path(text).stem().string() : text.substr(0, sign);
  if (name.empty() || policy.empty())
    throw std::invalid_argument(fmt::format("--policy {}: expected NAME, FILE.onnx or NAME=FILE.onnx", text));
  evaluation::Candidate candidate{name, {}};
  candidate.control.robot = arguments.robot;
  candidate.control.clips = arguments.clips;
  candidate.control.policy = policy;
  control::load_control(candidate.control);  // refuses a wrong candidate before hours of work
  return candidate;
}

std::vector<evaluation::Candidate> candidates(const apps::EvalArguments& arguments) {
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

sil::Scenario scenario(const apps::EvalArguments& arguments) {
  return sil::load_scenario(files::config_file("scenarios", "scenario", arguments.scenario.string()));
}

evaluation::Plants plants(const apps::EvalArguments& arguments) {
  evaluation::Plants plants;
  if (!arguments.nominal)
    plants.ranges =
        sim::load_variation_ranges(files::config_file("evaluation", "variation", arguments.variation.string()));
  return plants;
}

/// Shows the progress of the work during its own lifetime.
class Watch {
 public:
  explicit Watch(const apps::EvalArguments& arguments) {
    supervision_.jobs = arguments.jobs;
    supervision_.progress = {.report = [this](double share, std::string_view pieces) { show(share, pieces); },
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

/// Writes page and JSON to the folder, its tables or JSON to stdout. Returns the exit code of what the result is worth.
template <typename Result>
int hand_over(const apps::EvalArguments& arguments, const Result& result) {
  const work::Worth worth = worth_of(result);
  nlohmann::ordered_json json = to_json(result);
  add_to(json, worth);
  sil::write_json(arguments.out / (json["kind"].get<std::string>() + ".json"), json);
  page_of(result).write(arguments.out / "report.html");
  if (arguments.json) {
    apps::print_json(json);
  } else {
    if (!worth.reservations().empty()) std::cout << worth.sentence() << '\n';
    for (const pages::Table& table : tables_of(result)) {
      for (const std::string& line : pages::console_lines(table)) std::cout << line << '\n';
    }
    std::cout << "report in " << (arguments.out / "report.html").string() << '\n';
  }
  return worth.exit_code();
}

/// A film that may be made.
struct FilmOrder {
  std::string name;  ///< of the file beside the page
  std::function<std::string(const fs::path& file, const evaluation::Supervision&)> shoot;  ///< its error; empty: none
};

/// Errors of the films, one line each. films gets the names of those that were made.
std::vector<std::string> make_films(const apps::EvalArguments& arguments, const std::vector<FilmOrder>& orders,
                                    std::vector<std::string>& films) {
  const Watch watch(arguments);
  std::vector<std::optional<std::string>> failures(orders.size());  // empty: not begun
  evaluation::for_each_piece(orders.size(), watch.supervision(), [&](std::size_t i) {
    failures[i] = orders[i].shoot(arguments.out / orders[i].name, watch.supervision());
  });
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    if (!failures[i]) continue;
    if (failures[i]->empty()) {
      films.push_back(orders[i].name);
    } else {
      lines.push_back(*failures[i]);
    }
  }
  return lines;
}

/// (exit code of the table, errors of its films) => exit code
int with_films(int code, const std::vector<std::string>& failures) {
  for (const std::string& failure : failures) std::cerr << "pmg_eval: " << failure << '\n';
  if (apps::interrupt_requested != 0) return kInterrupted;
  return failures.empty() ? code : static_cast<int>(kBadInput);
}

int table1(const apps::EvalArguments& arguments) {
  evaluation::Table1 table;
  table.robot = arguments.robot;
  table.scenario_file = arguments.scenario.string();
  table.ranges_file = arguments.ranges_file();
  table.scenario = scenario(arguments);
  table.seeds = arguments.seeds;
  for (const evaluation::Candidate& c : candidates(arguments))
    table.cases.push_back({.name = c.name, .candidate = c, .plants = plants(arguments)});
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  for (int seed = 1; seed <= table.seeds; ++seed)
    table.plants.push_back(table.cases.front().plants.of(robot, static_cast<std::uint64_t>(seed)));
  if (arguments.video) sim::expect_ffmpeg();
  arguments.make_folder();
  table.campaign = evaluation::run_campaign(table.cases, table.in_phases(), table.seeds, arguments.gantry,
                                            Watch(arguments).supervision());
  measure_yardsticks(table, Watch(arguments).supervision());
  std::vector<std::string> failures;
  if (arguments.video && table.campaign.complete) {
    std::vector<FilmOrder> orders;
    for (const evaluation::Case& one : table.cases)
      orders.push_back(
          {.name = one.name + ".mp4", .shoot = [&](const fs::path& file, const evaluation::Supervision& supervision) {
             return film_case(one, table.scenario, file, supervision);
           }});
    failures = make_films(arguments, orders, table.films);
  }
  evaluate(table);
  return with_films(hand_over(arguments, table), failures);
}

int table2(const apps::EvalArguments& arguments) {
  evaluation::Table2 table;
  table.robot = arguments.robot;
  table.policy = candidate(arguments.policies.front(), arguments).control.policy;
  table.plants_file = arguments.plants.string();
  table.scenario_file = arguments.scenario.string();
  table.ranges = evaluation::load_plant_ranges(files::config_file("evaluation", "plants", arguments.plants.string()));
  table.scenario = scenario(arguments);
  arguments.make_folder();
  run_table2(table, arguments.out, Watch(arguments).supervision());
  return hand_over(arguments, table);
}

int table3(const apps::EvalArguments& arguments) {
  teleoperation::Table3 table;
  table.robot = arguments.robot;
  table.ranges_file = arguments.ranges_file();
  table.first = arguments.first;
  table.trials = arguments.tasks;
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  table.evaluated = {.name = c.name, .candidate = c, .plants = plants(arguments)};
  if (arguments.video) sim::expect_ffmpeg();
  arguments.make_folder();
  run_table3(table, Watch(arguments).supervision());
  std::vector<std::string> failures;
  if (arguments.video && table.complete) {
    std::vector<FilmOrder> orders;
    for (const teleoperation::FilmedTrial& one : trials_to_film(table))
      orders.push_back({.name = one.file(),
                        .shoot = [&table, one](const fs::path& file, const evaluation::Supervision& supervision) {
                          return film_trial(table, one, file, supervision);
                        }});
    failures = make_films(arguments, orders, table.films);
  }
  return with_films(hand_over(arguments, table), failures);
}

int push(const apps::EvalArguments& arguments) {
  evaluation::PushTest test;
  test.robot = arguments.robot;
  test.ranges_file = arguments.ranges_file();
  test.trials = arguments.trials;
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  test.evaluated = {.name = c.name, .candidate = c, .plants = plants(arguments)};
  arguments.make_folder();
  run_pushes(test, arguments.strengths_N_s, Watch(arguments).supervision());
  return hand_over(arguments, test);
}

int robust(const apps::EvalArguments& arguments) {
  evaluation::RobustnessTest test;
  test.robot = arguments.robot;
  test.scenario_file = arguments.scenario.string();
  test.ranges_file = arguments.ranges_file();
  test.scenario = scenario(arguments);
  test.seeds = arguments.seeds;
  test.cases = evaluation::robustness_cases(candidate(arguments.policies.front(), arguments), plants(arguments));
  arguments.make_folder();
  test.campaign =
      evaluation::run_campaign(test.cases, {test.scenario}, test.seeds, false, Watch(arguments).supervision());
  evaluate(test);
  return hand_over(arguments, test);
}

int gait(const apps::EvalArguments& arguments) {
  evaluation::GaitTest test;
  test.robot = arguments.robot;
  test.speed_m_s = arguments.speed_m_s;
  test.norms = arguments.norms.empty() ? evaluation::built_in_norms() : evaluation::load_norms(arguments.norms);
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  test.evaluated = {.name = c.name, .candidate = c, .plants = {}};
  arguments.make_folder();
  run_gait(test, Watch(arguments).supervision());
  return hand_over(arguments, test);
}

int steady(const apps::EvalArguments& arguments) {
  command_response::SteadyTest test;
  test.robot = arguments.robot;
  test.candidate = candidate(arguments.policies.front(), arguments);
  arguments.make_folder();
  run_steady(test, Watch(arguments).supervision());
  return hand_over(arguments, test);
}

int jumps(const apps::EvalArguments& arguments) {
  command_response::JumpTest test;
  test.robot = arguments.robot;
  test.ranges_file = arguments.ranges_file();
  test.seeds = arguments.seeds;
  test.duration_s = arguments.duration_s;
  const evaluation::Candidate c = candidate(arguments.policies.front(), arguments);
  test.evaluated = {.name = c.name, .candidate = c, .plants = plants(arguments)};
  arguments.make_folder();
  run_jumps(test, Watch(arguments).supervision());
  return hand_over(arguments, test);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Evaluates policies over many simulated robots.", "pmg_eval");
  apps::EvalArguments arguments;
  arguments.declare(app);
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "ending the runs under way, then the report of what is complete");
    const std::string command = arguments.finish(app);
    if (command == "table1") return table1(arguments);
    if (command == "table2") return table2(arguments);
    if (command == "table3") return table3(arguments);
    if (command == "push") return push(arguments);
    if (command == "robust") return robust(arguments);
    if (command == "steady") return steady(arguments);
    if (command == "jumps") return jumps(arguments);
    return gait(arguments);
  });
}
