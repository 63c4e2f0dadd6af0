// pmg_controller: the controller on its own host: real-time threads, wall clock, operators over LCM.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench_session.hpp"
#include "control/control_setup.hpp"
#include "control/mode_text.hpp"
#include "driving_window.hpp"
#include "io/lcm_link.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "runtime/comms.hpp"
#include "runtime/controller.hpp"
#include "runtime/controller_report.hpp"
#include "runtime/recorder.hpp"
#include "runtime/run_info.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/motors_in_force.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

constexpr int kCommsWait_ms = 5;   // how late a tick is published at most
constexpr double kListen_s = 0.5;  // fifty STATUS messages of another controller

constexpr const char* kFooter = R"(
Starts in Passive and waits for operators on LCM (pmg_send, pmg_watch). SIGINT, SIGTERM and SIGHUP damp the robot, close the
log and end the program. Software stops are not safety-rated: docs/reference/safety.md.

With --bench the robot excites one joint as soon as it stands (pmg_send stand), the others holding, and damps when all is
recorded. It must hang clear of the ground with its base held fast. Stops, faults and limits are in force as ever, and what
was recorded whole until then is kept; nothing begins again by itself.

Example:
  pmg_controller --hal sil --robot z1 --log out/first
  pmg_send walk --robot z1 --vx 0.4 --for 5
  pmg_controller --hal sil --viewer
  pmg_controller --hal sil --robot z1 --bench left_knee --excitation out/excitation --bench-out out/knee-bench

Exit codes: 0 ended by a signal, --duration or the bench's end, 1 it could not run on (the drives don't answer, or a thread failed; the robot
was damped), 2 bad input, or a network, name or log folder that can't be used.)";

struct Arguments {
  std::string hal;
  control::ControlSetup control;
  std::string name, lcm_url;
  fs::path log, motor, excitation, bench_out;
  std::string bench;
  bool no_log = false, gantry = false, viewer = false, no_realtime = false, print_config = false, json = false;
  std::uint64_t seed = 0;
  std::optional<double> duration_s;
  runtime::ControllerOptions threads;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.footer(kFooter);
  app.add_option("--hal", arguments.hal,
                 "the drives: sil, MuJoCo in their place, is the one backend of this build; can and ethercat are not "
                 "in it")
      ->required()
      ->check(apps::one_of({"sil", "can", "ethercat"}));
  app.add_option("--robot", arguments.control.robot, "robot's name below config/robots, or its folder")
      ->capture_default_str();
  app.add_option("--name", arguments.name, "name that messages are addressed to; the robot's own if not given");
  app.add_option("--policy", arguments.control.policy,
                 "policy's name below the robot's policies/, or none: drives follow the reference; robot.yaml's if not "
                 "given, and none with --bench");
  app.add_option("--clips", arguments.control.clips, "clip library; the robot's own clips/ if not given");
  app.add_option("--lcm-url", arguments.lcm_url, "LCM network; LCM_DEFAULT_URL or this computer alone if not given");
  CLI::Option* log = app.add_option("--log", arguments.log, "folder of the log; out/NAME-TIME if not given");
  app.add_flag("--no-log", arguments.no_log, "write no log but that of the seconds around a fault")->excludes(log);
  app.add_flag("--gantry", arguments.gantry,
               "sil: hang the robot in a gantry for ever; otherwise a hoist sets it down when it stands");
  app.add_flag("--viewer", arguments.viewer, "sil: a window with the robot, whose keys drive it");
  app.add_option("--motor", arguments.motor,
                 "sil: motor.yaml, how the drives really are; robot.yaml's if not given, none for none");
  CLI::Option* bench = app.add_option("--bench", arguments.bench, "excite this joint of the hanging robot once");
  CLI::Option* excitation = app.add_option("--excitation", arguments.excitation,
                                           "what to excite it by: a folder of pmg_calibrate_motor --make-excitation");
  CLI::Option* bench_out = app.add_option("--bench-out", arguments.bench_out, "folder of the bench that is recorded");
  excitation->needs(bench);
  bench_out->needs(bench);
  bench->needs(excitation)->needs(bench_out);
  app.add_option("--seed", arguments.seed, "sil: of the sensor noise")->capture_default_str();
  app.add_option("--bus-cpu", arguments.threads.bus.cpu, "the one CPU of the bus thread; -1: any")
      ->check(apps::in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--control-cpu", arguments.threads.control.cpu, "the one CPU of the control thread; -1: any")
      ->check(apps::in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--bus-priority", arguments.threads.bus.priority, "SCHED_FIFO priority of the bus thread")
      ->check(apps::in_range(1, 99))
      ->capture_default_str();
  app.add_option("--control-priority", arguments.threads.control.priority, "SCHED_FIFO priority of the control thread")
      ->check(apps::in_range(1, 99))
      ->capture_default_str();
  app.add_flag("--no-realtime", arguments.no_realtime, "ordinary scheduling: for trying things out, not for a robot");
  app.add_option("--duration", arguments.duration_s, "end after so many seconds")->check(apps::positive());
  app.add_flag("--print-config", arguments.print_config, "print the configuration in force as JSON and exit");
  app.add_flag("--json", arguments.json, "print how the run went as JSON on stdout at the end");
}

nlohmann::ordered_json thread_json(const runtime::ThreadSchedule& schedule) {
  return {{"priority", schedule.priority}, {"cpu", schedule.cpu}};
}

/// bench: null without --bench.
nlohmann::ordered_json config_json(const Arguments& arguments, const control::LoadedControl& loaded,
                                   const apps::BenchSession* bench) {
  nlohmann::ordered_json json = control::control_json(loaded);
  json["name"] = arguments.name;
  json["hal"] = arguments.hal;
  json["lcm_url"] = arguments.lcm_url;
  json["log"] = arguments.log.string();
  json["gantry"] = arguments.gantry;
  json["seed"] = arguments.seed;
  if (!arguments.motor.empty()) json["motor"] = arguments.motor.string();
  if (bench != nullptr) json["bench"] = bench->json();
  json["realtime"] = {{"asked_for", arguments.threads.realtime},
                      {"bus", thread_json(arguments.threads.bus)},
                      {"control", thread_json(arguments.threads.control)}};
  return json;
}

std::string utc_time() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday, utc.tm_hour,
                     utc.tm_min, utc.tm_sec);
}

/// Signals that end the program arrive nowhere but in wait_ms(); threads made later inherit that.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);  // a console that went away must not end the control of a robot
  }
  /// True when one came within this time.
  bool wait_ms(long timeout_ms) const {
    const timespec timeout{.tv_sec = timeout_ms / 1000, .tv_nsec = timeout_ms % 1000 * 1'000'000};
    return sigtimedwait(&signals_, nullptr, &timeout) > 0;
  }

 private:
  sigset_t signals_{};
};

/// Says what changes, as it happens.
class Console {
 public:
  Console(const model::RobotModel& robot, std::string name) : robot_(robot), name_(std::move(name)) {}

  void show(const runtime::ControllerNews& news) {
    if (news.mode == mode_ && news.hanging == hanging_) return;
    mode_ = news.mode;
    hanging_ = news.hanging;
    if (news.mode == control::Mode::kFault) {
      spdlog::error("FAULT, damping: {}", control::describe(news.fault, robot_));
      spdlog::error("{} Then: pmg_send reset --robot {}", control::advice(news.fault.code), name_);
      return;
    }
    const char* driving = news.driving.name.data();
    spdlog::info("mode: {}{}{}", control::mode_text(news.mode, news.hanging), *driving == '\0' ? "" : ", driven by ",
                 driving);
  }

 private:
  const model::RobotModel& robot_;
  std::string name_;
  control::Mode mode_ = control::Mode::kPassive;
  bool hanging_ = false;
};

void announce(const Arguments& arguments, const runtime::RunInfo& run, Variant variant) {
  spdlog::info("pmg_controller {}: {} on {}, bundle {}, policy {}", runtime::software_version(), run.robot, run.backend,
               run.bundle.substr(0, 12), run.policy);
  if (run.policy == "none") spdlog::warn("no policy: drives follow the reference, and nothing balances the robot");
  if (variant != Variant::kPmg) spdlog::warn("BASELINE {}: this policy is there for comparison", to_string(variant));
  spdlog::info("LCM {}, log {}{}", arguments.lcm_url, arguments.log.string(),
               arguments.no_log ? " (after a fault only)" : "");
  for (const std::string& refused : run.refused) spdlog::warn("NOT REAL-TIME: {}", refused);
}

/// The simulated robot, and the window on it if there is one.
struct Stage {
  sil::SimulatedRobot& robot;
  apps::DrivingWindow* window;  // may be null
};

/// Waits until somebody or something ends the run.
void supervise(runtime::Controller& controller, const EndSignals& signals, const Arguments& arguments,
               const Stage& stage, Console& console, const std::atomic<bool>& bench_over) {
  constexpr long kPoll_ms = 20, kKeys_ms = 5;
  if (stage.window != nullptr) stage.window->show(stage.robot);
  const auto start = std::chrono::steady_clock::now();
  const auto expired = [&] {
    return arguments.duration_s &&
           std::chrono::steady_clock::now() - start >= std::chrono::duration<double>(*arguments.duration_s);
  };
  bool signalled = false;
  while (!signalled && !expired() && !bench_over && controller.failure().empty()) {
    signalled = signals.wait_ms(stage.window == nullptr ? kPoll_ms : kKeys_ms);
    for (runtime::ControllerNews news; controller.news(news);) console.show(news);
    if (stage.window == nullptr) continue;
    stage.window->listen();
    if (!stage.window->closed()) continue;
    spdlog::info("the window was closed: velocity to zero first");
    return stage.window->let_go();
  }
}

runtime::RunInfo run_info(const Arguments& arguments, const control::LoadedControl& loaded,
                          const runtime::Controller& controller, const apps::BenchSession* bench) {
  return {.robot = arguments.name,
          .session = std::chrono::system_clock::now().time_since_epoch().count(),
          .policy = arguments.control.policy,
          .backend = arguments.hal,
          .options = config_json(arguments, loaded, bench).dump(),
          .bundle = loaded.bundle,
          .files = loaded.files,
          .realtime = controller.refused().empty(),
          .refused = controller.refused()};
}

/// What happens between the threads' start and their end; everything that input can spoil has been checked.
ExitCode run(const Arguments& arguments, const EndSignals& signals, runtime::Controller& controller,
             runtime::Comms& comms, runtime::Recorder& recorder, const Stage& stage, Console& console,
             const std::atomic<bool>& bench_over) {
  std::string failure;
  try {
    controller.start([&] { comms.step(kCommsWait_ms); }, [&] { recorder.drain(); });
    spdlog::info("mode: passive");
    supervise(controller, signals, arguments, stage, console, bench_over);
    failure = controller.failure();
    spdlog::info("{}: damping, then closing", failure.empty() ? "asked to end" : "can't run on");
    if (!controller.stop()) spdlog::error("the control thread did not confirm damping; the bus damped without it");
  } catch (const std::exception& error) {
    failure = error.what();
    controller.stop();  // before what its threads use goes away
  }
  recorder.close();
  if (!failure.empty()) spdlog::critical("{}", failure);
  return failure.empty() ? kOk : kFailed;
}

void report(const Arguments& arguments, const runtime::Controller& controller, const runtime::Recorder& recorder) {
  for (const std::string& line : runtime::punctuality_lines(controller)) spdlog::info(line);
  if (recorder.lost() > 0) spdlog::warn("{} ticks are not in the log", recorder.lost());
  if (!arguments.json) return;
  nlohmann::ordered_json json = {{"robot", arguments.name},
                                 {"log", arguments.log.string()},
                                 {"logged_ticks", recorder.written()},
                                 {"lost_ticks", recorder.lost()}};
  json.update(runtime::punctuality_json(controller));
  std::cout << json.dump(2) << '\n';
}

int run_controller(Arguments& arguments) {
  if (arguments.hal != "sil") {
    throw std::invalid_argument(fmt::format("--hal {}: this build has no {} backend; expected sil, the one that it has",
                                            arguments.hal, arguments.hal == "can" ? "CAN" : "EtherCAT"));
  }
  if (!arguments.bench.empty()) {
    if (arguments.control.policy.empty()) arguments.control.policy = "none";
    if (arguments.control.policy != "none") {
      throw std::invalid_argument("--bench excites a joint without a policy; expected --policy none");
    }
    arguments.gantry = true;
  }
  control::LoadedControl loaded = control::load_control(arguments.control);
  arguments.control.policy = loaded.policy_name;
  sil::expect_shared_host(loaded.options);
  std::optional<apps::BenchSession> bench;
  std::optional<runtime::ExcitationRecorder> excited;
  if (!arguments.bench.empty()) {
    bench.emplace(loaded.robot, arguments.bench, arguments.excitation, arguments.bench_out, loaded.options.dt_s);
    excited.emplace(bench->recorder());
    loaded.options.excitation = bench->plan();
  }
  if (arguments.name.empty()) arguments.name = loaded.robot.name;
  if (arguments.log.empty()) arguments.log = fs::path("out") / (arguments.name + "-" + utc_time());
  arguments.lcm_url = io::choose_lcm_url(arguments.lcm_url);
  arguments.threads.realtime = !arguments.no_realtime;
  if (arguments.print_config) {
    std::cout << config_json(arguments, loaded, bench ? &*bench : nullptr).dump(2) << '\n';
    return kOk;
  }

  const EndSignals signals;
  const io::WallClock clock;
  io::LcmLink link(arguments.lcm_url);
  sim::WorldOptions world_options = sil::world_with_noise(arguments.seed, true);
  world_options.motors = sim::motors_in_force(loaded.robot, arguments.motor);
  world_options.benched_joint = arguments.bench;
  sim::World world(loaded.robot, world_options);
  sil::SimulatedRobot robot(world, arguments.gantry ? sil::HoistedBy::kGantry : sil::HoistedBy::kCrane,
                            !arguments.no_log);
  std::optional<apps::DrivingWindow> window;
  if (arguments.viewer) window.emplace(world.mj_model(), arguments.name, arguments.lcm_url);
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, clock);
  runtime::Controller controller(loaded.robot, robot, *tick, arguments.threads);
  const runtime::RunInfo info = run_info(arguments, loaded, controller, bench ? &*bench : nullptr);
  announce(arguments, info, loaded.variant);

  const double rate_Hz = 1.0 / loaded.options.dt_s;
  const auto warn = [](const std::string& text) { spdlog::warn("{}", text); };
  runtime::Comms comms(link, controller.inbox(), controller.outbox(), loaded.robot, info, rate_Hz, clock);
  comms.on_warning = warn;
  comms.work(robot.hoist_line());
  for (const std::string& other : comms.listen_for_others(kListen_s)) spdlog::info("also on this network: {}", other);
  runtime::Recorder recorder(controller.outbox(), loaded.robot, info, clock,
                             {.directory = arguments.log, .log = !arguments.no_log, .control_rate_Hz = rate_Hz}, warn);
  std::atomic<bool> bench_over{false};
  recorder.after_record = [&](const control::TickRecord& record) {
    const sil::TruthSample* truth = robot.take_truth(record.state.bus_sample);
    if (truth != nullptr) recorder.write_truth(record.now_ns, truth->truth, truth->hoisted);
    if (!excited) return;
    excited->add(record);
    if (excited->progress().over) bench_over = true;
  };
  Console console(loaded.robot, arguments.name);
  const ExitCode code =
      run(arguments, signals, controller, comms, recorder, {robot, window ? &*window : nullptr}, console, bench_over);
  if (bench) spdlog::info("{}: {}", bench->write(*excited), arguments.bench_out.string());
  report(arguments, controller, recorder);
  if (bench && code == kOk && !bench->whole(*excited)) return kFailed;
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The controller on its own host: real-time threads, operators over LCM.", "pmg_controller");
  Arguments arguments;
  declare(app, arguments);
  const auto body = [&]() -> int {
    spdlog::set_default_logger(spdlog::stderr_color_mt("pmg"));
    spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
    return run_controller(arguments);
  };
  return apps::run_program(app, argc, argv, body, [&] { return control::told_bundle(arguments.control); });
}
