// pmg_sil: the controller against a MuJoCo simulation, playing a scenario in lockstep or with the robot's threads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "control/control_setup.hpp"
#include "files/config_folders.hpp"
#include "json_output.hpp"
#include "program.hpp"
#include "result_folder.hpp"
#include "runtime/bench_session.hpp"
#include "sil/failing_parts.hpp"
#include "sil/failure_report.hpp"
#include "sil/live_view.hpp"
#include "sil/run_text.hpp"
#include "sil/summary.hpp"
#include "sil_arguments.hpp"
#include "sil_play.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/video_writer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kFellOrFault = 1, kBadInput = 2, kInterrupted = 130 };

using Arguments = apps::SilArguments;

const apps::Results kResults = {"a run", {"log.lcm", "timing.csv", "summary.json", "video.mp4"}};

/// Checks for required options. CLI11 cannot: --export-mjcf and --print-config need fewer options.
void require(const fs::path& value, const char* option) {
  if (value.empty())
    throw std::invalid_argument(fmt::format("{} is missing (pmg_sil --help shows an example)", option));
}

int simulate(Arguments arguments) {
  const bool benching = !arguments.bench.empty();
  if (benching) {
    require(arguments.excitation, "--excitation");
    runtime::expect_no_policy(arguments.control);
    arguments.gantry = true;
  } else if (!arguments.by_operators()) {
    require(arguments.scenario, "--scenario");
  }
  // All checks of the input come first: bad input leads to no output.
  control::LoadedControl loaded = control::load_control(arguments.control);
  arguments.control.policy = loaded.policy_name;
  if (arguments.realtime) sil::expect_shared_host(loaded.options);
  std::optional<runtime::BenchSession> bench;
  std::optional<runtime::ExcitationRecorder> recorder;
  if (benching) {
    bench.emplace(loaded.robot, arguments.bench, arguments.excitation, arguments.out, loaded.options);
    recorder.emplace(bench->recorder());
    loaded.options.excitation = bench->plan();
  }
  const sil::Scenario scenario =
      benching ? sil::bench_scenario(bench->joint().name, bench->duration_s())
      : arguments.by_operators()
          ? sil::endless_scenario()
          : sil::load_scenario(files::config_file("scenarios", "scenario", arguments.scenario.string()));
  sil::FailureClock failure_clock;
  std::vector<sil::Failure> failures;
  std::optional<sil::FailingTick> failing_tick;
  if (!arguments.inject.empty()) {
    failures = sil::load_failures(arguments.inject, loaded.robot);
    loaded.policy =
        std::make_unique<sil::FailingPolicy>(std::move(loaded.policy), failures, failure_clock, arguments.realtime);
    loaded.options.spoiler = &failing_tick.emplace(failures, failure_clock, arguments.realtime);
  }
  if (arguments.print_config) {
    apps::print_json(config_json(arguments, loaded, bench ? &*bench : nullptr));
    return kOk;
  }
  require(arguments.out, "--out");
  apps::expect_unused(arguments.out, kResults, arguments.overwrite);
  sim::WorldOptions world_options = sil::world_with_noise(arguments.seed, arguments.gantry || arguments.by_operators());
  world_options.benched_joint = arguments.bench;
  if (!arguments.vary.empty()) {
    sim::vary(world_options,
              sim::load_variation_ranges(files::config_file("evaluation", "variation", arguments.vary.string())),
              loaded.robot, arguments.seed);
  }
  world_options.motors = sim::motors_in_force(loaded.robot, arguments.motor);
  sim::World world(loaded.robot, world_options);
  std::optional<sil::LiveView> view;
  if (arguments.viewer) view.emplace(world, loaded.robot);
  if (arguments.video) sim::expect_ffmpeg();
  apps::make_result_folder(arguments.out, kResults, arguments.overwrite);
  io::LogWriter log_file(arguments.out / "log.lcm");
  if (is_baseline(loaded.variant)) {
    std::cerr << fmt::format("baseline {}: this policy is there for comparison\n", to_string(loaded.variant));
  }
  const io::WallClock wall_clock;
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, wall_clock);
  const apps::Stage stage{arguments,
                          loaded,
                          scenario,
                          world,
                          log_file,
                          *tick,
                          view ? &*view : nullptr,
                          bench ? &*bench : nullptr,
                          recorder ? &*recorder : nullptr,
                          failures,
                          failure_clock};

  const std::int64_t start_ns = wall_clock.now_ns();
  const apps::Played played = arguments.realtime ? apps::play_realtime(stage) : apps::play_lockstep(stage);
  const double wall_s = static_cast<double>(wall_clock.now_ns() - start_ns) * 1e-9;
  log_file.flush();
  played.timing.write_csv(arguments.out / "timing.csv");
  nlohmann::ordered_json summary =
      sil::summary_json({loaded.robot.name, scenario.name, arguments.control.policy, arguments.seed, wall_s,
                         arguments.control.policy == "none" ? "" : to_string(loaded.variant)},
                        played.outcome, played.timing, loaded.robot);
  if (!played.realtime.is_null()) summary["punctuality"] = played.realtime;
  if (bench) summary["bench"] = bench->write(*recorder);
  if (!failures.empty()) summary["injected"] = sil::failures_json(failures, played.reactions, played.outcome.faults);
  if (!played.film_failure.empty()) summary["film_failure"] = played.film_failure;
  sil::write_json(arguments.out / "summary.json", summary);
  if (arguments.json) {
    apps::print_json(summary);
  } else if (bench) {
    std::cout << fmt::format("{}; results in {}\n", summary["bench"].get<std::string>(), arguments.out.string());
  } else {
    std::cout << sil::run_text(played.outcome, summary);
    if (!failures.empty()) std::cout << sil::failures_text(summary["injected"]);
    std::cout << fmt::format("results in {}\n", arguments.out.string());
  }
  const sil::RunOutcome& outcome = played.outcome;
  if (outcome.interrupted && !arguments.by_operators()) return kInterrupted;
  if (!played.film_failure.empty()) return kBadInput;
  if (bench && !bench->whole(*recorder)) return kFellOrFault;
  return outcome.fell || outcome.diverged || !outcome.faults.empty() ? kFellOrFault : kOk;
}

int export_mjcf(const Arguments& arguments) {
  const model::RobotModel robot = control::load_robot(arguments.control);
  const std::string text = sim::mjcf(robot, sil::world_with_noise(arguments.seed, arguments.gantry));
  std::ofstream out(arguments.export_mjcf);
  out << text;
  if (!out.flush()) throw std::runtime_error(arguments.export_mjcf.string() + ": can't be written");
  return kOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs the controller against a MuJoCo simulation, playing a scenario in lockstep or, with --realtime, in "
      "threads.",
      "pmg_sil");
  Arguments arguments;
  arguments.declare(app);
  const auto body = [&]() -> int {
    if (!arguments.export_mjcf.empty()) return export_mjcf(arguments);
    apps::notice({SIGINT, SIGTERM}, "closing film and log, then the summary");
    return simulate(arguments);
  };
  return apps::run_program(app, argc, argv, body, [&] { return control::told_bundle(arguments.control); });
}
