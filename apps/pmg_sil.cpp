// pmg_sil: the controller against a MuJoCo simulation, playing a scenario in lockstep or with the robot's threads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench_session.hpp"
#include "control/control_setup.hpp"
#include "control/mode_text.hpp"
#include "io/lcm_link.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "progress_line.hpp"
#include "runtime/comms.hpp"
#include "runtime/controller_report.hpp"
#include "sil/film.hpp"
#include "sil/live_view.hpp"
#include "sil/lockstep.hpp"
#include "sil/realtime_run.hpp"
#include "sil/sil_hal.hpp"
#include "sil/summary.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/video_writer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kFellOrFault = 1, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
Writes DIR/log.lcm (simulation time only: same binary, inputs and seed give the same bytes), DIR/timing.csv (wall times),
DIR/summary.json, and with --video DIR/video.mp4. With --realtime the controller's threads run by the wall clock, and
summary.json says under "punctuality" how well they kept their times. With --realtime and no scenario operators drive (pmg_keyboard,
pmg_send), a hoist sets the robot down when it stands, and Ctrl-C or closing the window ends the run.

With --bench one joint of the hanging robot is excited while the others hold, and DIR is a bench of that joint for
pmg_calibrate_motor and pmg_diagnose: bench.yaml, runs.csv, runs/. The other files are as ever.

Example:
  pmg_sil --robot z1 --scenario config/scenarios/tour.yaml --out out/tour --video
  pmg_sil --robot z1 --realtime --viewer --out out/drive
  pmg_sil --robot z1 --bench left_knee --excitation out/excitation --motor out/knee/motor.yaml --out out/knee-bench

Exit codes: 0 the scenario (the bench) ran to its end, or operators drove until it was ended, 1 the robot fell or a fault latched, 2 bad input or
output (a film that fails leaves the other results whole), 130 interrupted or the viewer's window closed (what was done until then is kept).)";

struct Arguments {
  control::ControlSetup control;
  fs::path scenario, out, export_mjcf, motor, vary, excitation;
  std::string bench, lcm_url;
  std::uint64_t seed = 0;
  bool gantry = false, realtime = false, video = false, viewer = false, json = false, print_config = false;
  bool by_operators() const { return realtime && scenario.empty(); }
};

void declare(CLI::App& app, Arguments& arguments) {
  app.footer(kFooter);
  app.add_option("--robot", arguments.control.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
  app.add_option("--scenario", arguments.scenario, "scenario to play (YAML); with --realtime it may be left out");
  app.add_option("--out", arguments.out, "folder for the results; made if absent");
  app.add_option("--policy", arguments.control.policy,
                 "policy's name below the robot's policies/, or none: drives follow the reference; robot.yaml's if not "
                 "given, and none with --bench");
  app.add_option(
         "--blend", arguments.control.blend,
         "how clips are mixed: as the library says, gain, corners (combined commands keep their size), or paper for "
         "the paper's weights to the letter")
      ->check(apps::one_of({"library", "gain", "paper", "corners"}))
      ->capture_default_str();
  app.add_option("--clips", arguments.control.clips, "clip library; the robot's own clips/ if not given");
  app.add_option(
      "--motor", arguments.motor,
      "motor.yaml of pmg_calibrate_motor: how the drives really are; robot.yaml's if not given, none for none");
  app.add_flag("--gantry", arguments.gantry, "hang the robot in a gantry for the whole run");
  app.add_option("--vary", arguments.vary,
                 "draw the simulated robot, its ground and its noise from these ranges (YAML) by the seed");
  app.add_option("--seed", arguments.seed, "of the sensor noise")->capture_default_str();
  CLI::Option* realtime = app.add_flag("--realtime", arguments.realtime,
                                       "the robot's threads and the wall clock instead of lockstep; not reproducible");
  app.add_option("--lcm-url", arguments.lcm_url,
                 "where operators are heard; LCM_DEFAULT_URL or this computer alone if not given")
      ->needs(realtime)
      ->excludes("--scenario");
  CLI::Option* video = app.add_flag("--video", arguments.video, "film the run (needs ffmpeg)")->excludes(realtime);
  CLI::Option* bench =
      app.add_option("--bench", arguments.bench, "excite this joint of the hanging robot and write a bench of it")
          ->excludes(realtime)
          ->excludes("--scenario");
  app.add_option("--excitation", arguments.excitation,
                 "what to excite it by: a folder of pmg_calibrate_motor --make-excitation")
      ->needs(bench);
  app.add_flag("--viewer", arguments.viewer, "watch the run in a window, at the speed of real time; Esc or q ends it")
      ->excludes(video);
  app.add_option("--export-mjcf", arguments.export_mjcf, "write the robot's MuJoCo model to this file and exit");
  app.add_flag("--print-config", arguments.print_config, "print the configuration in force as JSON and exit");
  app.add_flag("--json", arguments.json, "print summary.json on stdout instead of the short report");
}

/// A flag's absence that CLI11 can't judge, because --export-mjcf and --print-config need less.
void require(const fs::path& value, const char* option) {
  if (value.empty())
    throw std::invalid_argument(fmt::format("{} is missing (pmg_sil --help shows an example)", option));
}

/// bench: null without --bench.
nlohmann::ordered_json config_json(const Arguments& arguments, const control::LoadedControl& loaded,
                                   const apps::BenchSession* bench) {
  nlohmann::ordered_json json = control::control_json(loaded);
  json["scenario"] = arguments.scenario.string();
  json["seed"] = arguments.seed;
  json["gantry"] = arguments.gantry;
  if (bench != nullptr) json["bench"] = bench->json();
  if (!arguments.vary.empty()) json["vary"] = arguments.vary.string();
  if (!arguments.motor.empty()) json["motor"] = arguments.motor.string();
  json["sensor_noise"] = {{"gyro_rad_s", sil::kGyroNoise_rad_s},
                          {"encoder_rad", sil::kEncoderNoise_rad},
                          {"orientation_rad", sil::kOrientationNoise_rad}};
  return json;
}

void show(apps::ProgressLine& line, const sil::RunProgress& progress) {
  const std::string of = std::isfinite(progress.duration_s) ? fmt::format(" / {:.1f}", progress.duration_s) : "";
  line.show(fmt::format("{:6.1f}{} s  {:8} {}", progress.time_s, of,
                        control::mode_text(progress.result.mode, progress.result.hanging), progress.step.text));
}

void report(const sil::RunOutcome& outcome, const nlohmann::ordered_json& summary, const fs::path& out) {
  const sil::TrackingSummary& tracking = outcome.tracking;
  std::cout
      << fmt::format("{}: {:.1f} s simulated ({:.1f} s on the gantry), {:.1f}x real time, {}{}\n",
                     summary["scenario"].get<std::string>(), outcome.duration_s, outcome.hoisted_s,
                     summary["realtime_factor"].get<double>(), outcome.fell ? "FELL" : "did not fall",
                     outcome.interrupted ? ", interrupted" : "")
      << fmt::format(
             "tracking over {:.1f} s: velocity {:.3f} m/s, yaw {:.3f} rad/s, pitch {:.3f} rad, roll {:.3f} rad, "
             "height {:.3f} m\n",
             tracking.followed_s, tracking.lin_vel_mae_m_s, tracking.yaw_vel_mae_rad_s, tracking.pitch_mae_rad,
             tracking.roll_mae_rad, tracking.height_mae_m)
      << fmt::format(
             "reference slip: single support {:.4f} m/s at most, double support {:.4f} m/s mean, {:.4f} m/s p95\n",
             outcome.reference_slip.single_support_max_m_s, outcome.reference_slip.double_support_mean_m_s,
             outcome.reference_slip.double_support_p95_m_s);
  if (outcome.hanging_s > 0.0) {
    std::cout << fmt::format(
        "the feet carried nothing for {:.1f} s: there the policy did not run, nor did the robot walk\n",
        outcome.hanging_s);
  }
  if (outcome.diverged) std::cout << "the simulation diverged\n";
  for (const auto& fault : summary["faults"]) {
    std::cout << fmt::format("fault at {:.2f} s: {}\n", fault["t_s"].get<double>(), fault["text"].get<std::string>());
  }
  if (summary.contains("punctuality")) {
    for (const char* thread : {"control", "bus"}) {
      const auto& times = summary["punctuality"][thread];
      std::cout << fmt::format("{} thread: {} cycles, wake-up p50 {:.0f} us, p99 {:.0f} us, {} delayed by the host\n",
                               thread, times["cycles"].get<std::int64_t>(), times["wake_us"]["p50"].get<double>(),
                               times["wake_us"]["p99"].get<double>(), times["delayed_count"].get<std::int64_t>());
    }
  }
  std::cout << fmt::format("results in {}\n", out.string());
}

/// A scenario that was played, either way.
struct Played {
  sil::RunOutcome outcome;
  sil::StageTiming timing;
  nlohmann::ordered_json realtime;  // null in lockstep
  std::string film_failure;         // empty: none, or no film
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
  const apps::BenchSession* bench;          // may be null
  runtime::ExcitationRecorder* excitation;  // null without a bench
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
  sil::SilHal bus(stage.world);
  sil::WorldPlant plant(stage.world);
  runtime::TickLog log(stage.log_file, robot, run_info(stage), rate_Hz);
  std::optional<sil::Film> film;
  if (stage.arguments.video) film.emplace(stage.world, stage.arguments.out / "video.mp4");
  apps::ProgressLine progress;
  sil::Lockstep lockstep(robot, bus, plant, stage.tick, stage.scenario, &log,
                         {.balanced_by_policy = stage.balanced_by_policy(), .always_hoisted = stage.arguments.gantry});
  lockstep.interrupted = [&stage] { return stage.over(); };
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
    show(progress, now);
  };
  const sil::RunOutcome outcome = lockstep.run();
  progress.clear();
  if (film && film->failure().empty()) {
    film->close();
    if (!film->failure().empty()) std::cerr << fmt::format("pmg_sil: {}\n", film->failure());
  }
  return {outcome, lockstep.timing(), nullptr, film ? film->failure() : ""};
}

/// Who speaks to the controller over the network when no scenario does.
class Operators {
 public:
  /// Keeps references. Throws std::runtime_error when there is no such network, or a controller of this name on it.
  Operators(const Stage& stage, const runtime::RunInfo& info, runtime::Controller& controller,
            sil::SimulatedRobot& simulated)
      : link_(io::choose_lcm_url(stage.arguments.lcm_url)),
        comms_(link_, controller.inbox(), controller.outbox(), stage.loaded.robot, info,
               1.0 / stage.loaded.options.dt_s, clock_) {
    constexpr double kListen_s = 0.5;  // fifty STATUS messages of another controller
    comms_.work(simulated.hoist_line());
    comms_.on_warning = [](const std::string& text) { std::cerr << text << '\n'; };
    comms_.listen_for_others(kListen_s, [] { return apps::interrupt_requested != 0; });
    std::cerr << fmt::format("{} hears operators on {}: pmg_keyboard, pmg_send\n", info.robot, link_.url());
  }
  void step() {
    constexpr int kWait_ms = 5;
    comms_.step(kWait_ms);
  }

 private:
  io::WallClock clock_;
  io::LcmLink link_;
  runtime::Comms comms_;
};

Played play_realtime(const Stage& stage) {
  const model::RobotModel& robot = stage.loaded.robot;
  const double rate_Hz = 1.0 / stage.loaded.options.dt_s;
  sil::SimulatedRobot simulated(stage.world,
                                stage.arguments.gantry           ? sil::HoistedBy::kGantry
                                : stage.arguments.by_operators() ? sil::HoistedBy::kCrane
                                                                 : sil::HoistedBy::kScenario,
                                true);
  runtime::Controller controller(robot, simulated, stage.tick);
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
    show(progress, now);
  };
  const sil::RunOutcome outcome = run.run();
  progress.clear();
  return {outcome, run.timing(), runtime::punctuality_json(controller), ""};
}

/// Stands for as long as the excitation takes, then damps.
sil::Scenario bench_scenario(const apps::BenchSession& bench, double control_period_s) {
  constexpr double kEntry_s = 2.0, kDamping_s = 0.5;
  const double stand_s = bench.duration_s(control_period_s) + kEntry_s;
  sil::ScenarioStep stand, damping;
  stand.duration_s = damping.start_s = stand_s;
  stand.text = "excite " + bench.joint().name;
  damping.duration_s = kDamping_s;
  damping.text = "damping";
  damping.mode = control::Mode::kDamping;
  return {.name = "bench of " + bench.joint().name, .steps = {stand, damping}};
}

/// Names a run that operators drive until it is ended.
sil::Scenario endless_scenario() {
  sil::ScenarioStep step;
  step.duration_s = std::numeric_limits<double>::infinity();
  step.text = "operators drive";
  return {.name = "operators", .steps = {step}};
}

int simulate(Arguments arguments) {
  const bool benching = !arguments.bench.empty();
  if (benching) {
    require(arguments.excitation, "--excitation");
    if (arguments.control.policy.empty()) arguments.control.policy = "none";
    if (arguments.control.policy != "none") {
      throw std::invalid_argument("--bench excites a joint without a policy; expected --policy none");
    }
    arguments.gantry = true;
  } else if (!arguments.by_operators()) {
    require(arguments.scenario, "--scenario");
  }
  // Everything that input can spoil comes first: nothing is written for bad input.
  control::LoadedControl loaded = control::load_control(arguments.control);
  arguments.control.policy = loaded.policy_name;
  if (arguments.realtime) sil::expect_shared_host(loaded.options);
  std::optional<apps::BenchSession> bench;
  std::optional<runtime::ExcitationRecorder> recorder;
  if (benching) {
    bench.emplace(loaded.robot, arguments.bench, arguments.excitation, arguments.out, loaded.options.dt_s);
    recorder.emplace(bench->recorder());
    loaded.options.excitation = bench->plan();
  }
  const sil::Scenario scenario = benching                   ? bench_scenario(*bench, loaded.options.dt_s)
                                 : arguments.by_operators() ? endless_scenario()
                                                            : sil::load_scenario(arguments.scenario);
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
                    recorder ? &*recorder : nullptr};

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
  if (!played.film_failure.empty()) summary["film_failure"] = played.film_failure;
  sil::write_json(arguments.out / "summary.json", summary);
  if (arguments.json) {
    std::cout << summary.dump(2) << '\n';
  } else if (bench) {
    std::cout << fmt::format("{}; results in {}\n", summary["bench"].get<std::string>(), arguments.out.string());
  } else {
    report(played.outcome, summary, arguments.out);
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
  declare(app, arguments);
  const auto body = [&]() -> int {
    if (!arguments.export_mjcf.empty()) return export_mjcf(arguments);
    apps::notice({SIGINT, SIGTERM}, "closing film and log, then the summary");
    return simulate(arguments);
  };
  return apps::run_program(app, argc, argv, body, [&] { return control::told_bundle(arguments.control); });
}
