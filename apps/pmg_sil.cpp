// pmg_sil: the controller against a MuJoCo simulation, playing a scenario in lockstep or with the robot's threads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "control/control_setup.hpp"
#include "io/lcm_link.hpp"
#include "program.hpp"
#include "progress_line.hpp"
#include "runtime/bench_session.hpp"
#include "runtime/comms.hpp"
#include "runtime/controller_report.hpp"
#include "sil/failing_parts.hpp"
#include "sil/failure_report.hpp"
#include "sil/film.hpp"
#include "sil/live_view.hpp"
#include "sil/lockstep.hpp"
#include "sil/realtime_run.hpp"
#include "sil/run_text.hpp"
#include "sil/sil_hal.hpp"
#include "sil/summary.hpp"
#include "sil_arguments.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/video_writer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kFellOrFault = 1, kBadInput = 2, kInterrupted = 130 };

using Arguments = apps::SilArguments;

/// A flag's absence that CLI11 can't judge, because --export-mjcf and --print-config need less.
void require(const fs::path& value, const char* option) {
  if (value.empty())
    throw std::invalid_argument(fmt::format("{} is missing (pmg_sil --help shows an example)", option));
}

/// A scenario that was played, either way.
struct Played {
  sil::RunOutcome outcome;
  sil::StageTiming timing;
  nlohmann::ordered_json realtime;                // null in lockstep
  std::string film_failure;                       // empty: none, or no film
  std::vector<sil::FailureReaction> reactions{};  // one for each failure that was injected
};

/// What both ways of playing need.
struct Stage {
  const Arguments& arguments;
  const control::LoadedControl& loaded;
  const sil::Scenario& scenario;
  sim::World& world;
  io::LogWriter& log_file;
  control::Tick& tick;
  sil::LiveView* view;                      // may be null
  const runtime::BenchSession* bench;       // may be null
  runtime::ExcitationRecorder* excitation;  // null without a bench
  const std::vector<sil::Failure>& failures;
  sil::FailureClock& failure_clock;
  bool over() const { return apps::interrupt_requested != 0 || (view != nullptr && view->closed()); }
  bool balanced_by_policy() const { return arguments.control.policy != "none"; }
};

runtime::RunInfo run_info(const Stage& stage) {
  return {.robot = stage.loaded.robot.name,
          .policy = stage.arguments.control.policy,
          .options = config_json(stage.arguments, stage.loaded, stage.bench).dump(),
          .bundle = stage.loaded.bundle,
          .files = stage.loaded.files};
}

Played play_lockstep(const Stage& stage) {
  const model::RobotModel& robot = stage.loaded.robot;
  const double rate_Hz = 1.0 / stage.loaded.options.dt_s;
  sil::SilHal drives(stage.world);
  sil::FailingBus bus(drives, stage.failures, robot, stage.failure_clock, false);
  sil::WorldPlant plant(stage.world);
  runtime::TickLog log(stage.log_file, robot, run_info(stage), rate_Hz);
  std::optional<sil::Film> film;
  if (stage.arguments.video) film.emplace(stage.world, stage.arguments.out / "video.mp4");
  apps::ProgressLine progress;
  sil::Lockstep lockstep(robot, bus, plant, stage.tick, stage.scenario, &log,
                         {.balanced_by_policy = stage.balanced_by_policy(), .always_hoisted = stage.arguments.gantry});
  lockstep.interrupted = [&stage] { return stage.over(); };
  if (!stage.failures.empty()) {
    lockstep.bus_sleeps = [&bus] { return bus.bus_sleeps(); };
    lockstep.control_sleeps = [&bus] { return bus.control_sleeps(); };
    lockstep.while_bus_sleeps = [&bus] { bus.idle(); };
  }
  if (stage.excitation != nullptr) {
    lockstep.after_record = [&stage](const control::TickRecord& record) { stage.excitation->add(record); };
  }
  lockstep.after_tick = [&](const sil::RunProgress& now) {
    if (film) {
      const bool rolling = film->failure().empty();
      film->after_tick(now);
      if (rolling && !film->failure().empty()) {
        progress.clear();
        std::cerr << fmt::format("pmg_sil: {}; the run goes on without a film\n", film->failure());
      }
    }
    if (stage.view != nullptr) stage.view->after_tick(now);
    progress.show(sil::progress_text(now));
  };
  const sil::RunOutcome outcome = lockstep.run();
  progress.clear();
  if (film && film->failure().empty()) {
    film->close();
    if (!film->failure().empty()) std::cerr << fmt::format("pmg_sil: {}\n", film->failure());
  }
  return {outcome, lockstep.timing(), nullptr, film ? film->failure() : "", bus.reactions()};
}

/// Who speaks to the controller over the network when no scenario does.
class Operators {
 public:
  /// Keeps references. Throws std::runtime_error when there is no such network, or a controller of this name on it.
  Operators(const Stage& stage, const runtime::RunInfo& info, runtime::Controller& controller,
            sil::SimulatedRobot& simulated)
      : lock_(info.robot, io::choose_lcm_url(stage.arguments.lcm_url)),
        link_(io::choose_lcm_url(stage.arguments.lcm_url)),
        comms_(link_, controller.inbox(), controller.outbox(), stage.loaded.robot, info,
               1.0 / stage.loaded.options.dt_s, clock_) {
    constexpr double kListen_s = 0.5;  // fifty STATUS messages of another controller
    comms_.work(simulated.hoist_line());
    comms_.on_warning = [](const std::string& text) { std::cerr << text << '\n'; };
    comms_.listen_for_others(kListen_s, [] { return apps::interrupt_requested != 0; });
    claim_.emplace(comms_.hold_name());
    std::cerr << fmt::format("{} hears operators on {}: pmg_keyboard, pmg_send\n", info.robot, link_.url());
  }
  void step() {
    constexpr int kWait_ms = 5;
    claim_.reset();
    comms_.step(kWait_ms);
  }

 private:
  io::WallClock clock_;
  runtime::NameLock lock_;
  io::LcmLink link_;
  runtime::Comms comms_;
  std::optional<runtime::HeldClaim> claim_;
};

Played play_realtime(const Stage& stage) {
  const model::RobotModel& robot = stage.loaded.robot;
  const double rate_Hz = 1.0 / stage.loaded.options.dt_s;
  sil::SimulatedRobot simulated(stage.world,
                                stage.arguments.gantry           ? sil::HoistedBy::kGantry
                                : stage.arguments.by_operators() ? sil::HoistedBy::kCrane
                                                                 : sil::HoistedBy::kScenario,
                                true);
  sil::FailingBus bus(simulated, stage.failures, robot, stage.failure_clock, true);
  runtime::Controller controller(robot, bus, stage.tick);
  for (const std::string& refused : controller.refused()) std::cerr << "not real-time: " << refused << '\n';
  runtime::RunInfo info = run_info(stage);
  info.session = std::chrono::system_clock::now().time_since_epoch().count();
  info.realtime = controller.refused().empty();
  info.refused = controller.refused();
  runtime::TickLog log(stage.log_file, robot, info, rate_Hz);
  apps::ProgressLine progress;
  sil::RealtimeRun run(robot, simulated, controller, stage.scenario, &log,
                       !stage.balanced_by_policy() && !stage.arguments.gantry);
  std::optional<Operators> operators;
  if (stage.arguments.by_operators()) {
    operators.emplace(stage, info, controller, simulated);
    run.operators = [&operators] { operators->step(); };
  }
  run.interrupted = [&] {
    if (stage.view != nullptr) stage.view->draw(simulated);
    return stage.over();
  };
  run.after_tick = [&](const sil::RunProgress& now) {
    if (stage.view != nullptr) stage.view->note(now);
    progress.show(sil::progress_text(now));
  };
  const sil::RunOutcome outcome = run.run();
  progress.clear();
  return {outcome, run.timing(), runtime::punctuality_json(controller), "", bus.reactions()};
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
  // Everything that input can spoil comes first: nothing is written for bad input.
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
  const sil::Scenario scenario = benching ? sil::bench_scenario(bench->joint().name, bench->duration_s())
                                 : arguments.by_operators() ? sil::endless_scenario()
                                                            : sil::load_scenario(arguments.scenario);
  sil::FailureClock failure_clock;
  std::vector<sil::Failure> failures;
  if (!arguments.inject.empty()) {
    failures = sil::load_failures(arguments.inject, loaded.robot);
    loaded.policy =
        std::make_unique<sil::FailingPolicy>(std::move(loaded.policy), failures, failure_clock, arguments.realtime);
  }
  if (arguments.print_config) {
    std::cout << config_json(arguments, loaded, bench ? &*bench : nullptr).dump(2) << '\n';
    return kOk;
  }
  require(arguments.out, "--out");
  sim::WorldOptions world_options = sil::world_with_noise(arguments.seed, arguments.gantry || arguments.by_operators());
  world_options.benched_joint = arguments.bench;
  if (!arguments.vary.empty()) {
    sim::vary(world_options, sim::load_variation_ranges(arguments.vary), loaded.robot, arguments.seed);
  }
  world_options.motors = sim::motors_in_force(loaded.robot, arguments.motor);
  sim::World world(loaded.robot, world_options);
  std::optional<sil::LiveView> view;
  if (arguments.viewer) view.emplace(world, loaded.robot);
  if (arguments.video) sim::expect_ffmpeg();
  fs::create_directories(arguments.out);
  io::LogWriter log_file(arguments.out / "log.lcm");
  if (loaded.variant != Variant::kPmg) {
    std::cerr << fmt::format("baseline {}: this policy is there for comparison\n", to_string(loaded.variant));
  }
  const io::WallClock wall_clock;
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, wall_clock);
  const Stage stage{arguments,
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
  const Played played = arguments.realtime ? play_realtime(stage) : play_lockstep(stage);
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
    std::cout << summary.dump(2) << '\n';
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
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.control.robot));
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
