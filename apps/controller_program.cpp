#include "controller_program.hpp"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "control/mode_text.hpp"
#include "controller_arguments.hpp"
#include "controller_doctor.hpp"
#include "controller_excitation.hpp"
#include "imu/imu_backend.hpp"
#include "injection.hpp"
#include "io/lcm_link.hpp"
#include "io/plain_text.hpp"
#include "json_output.hpp"
#include "program.hpp"
#include "recording/recorder.hpp"
#include "recording/run_folder.hpp"
#include "recording/run_info.hpp"
#include "runtime/comms.hpp"
#include "runtime/controller_report.hpp"
#include "seal/controller_seal.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2 };

constexpr int kCommsWait_ms = 5;   // how late a tick is published at most
constexpr double kListen_s = 0.5;  // fifty STATUS messages of another controller

using Arguments = apps::ControllerArguments;

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

/// A message on the console without what a terminal would act on, whoever chose the names in it.
class PlainMessage : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/, spdlog::memory_buf_t& to) override {
    const std::string plain = io::plain_text({message.payload.data(), message.payload.size()});
    to.append(plain.data(), plain.data() + plain.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<PlainMessage>(); }
};

/// Says what changes, as it happens.
class Console {
 public:
  Console(const model::RobotModel& robot, std::string name) : robot_(robot), name_(std::move(name)) {}

  void show(const runtime::ControllerNews& news) {
    if (news.mode == mode_ && news.hanging == hanging_ && news.sitting == sitting_) return;
    mode_ = news.mode;
    hanging_ = news.hanging;
    if (news.mode == control::Mode::kFault) {
      const bool sat = std::exchange(sitting_, news.sitting);
      if (sat) return spdlog::error("the sit-down is over: damping");
      spdlog::error("FAULT, {}: {}", news.sitting ? "sitting down" : "damping", faults::describe(news.fault, robot_));
      spdlog::error("{} Then: pmg_send reset --robot {}", faults::advice(news.fault.code), name_);
      return;
    }
    sitting_ = false;
    const char* driving = news.driving.name.data();
    spdlog::info("mode: {}{}{}", control::mode_text(news.mode, news.hanging), *driving == '\0' ? "" : ", driven by ",
                 driving);
  }

 private:
  const model::RobotModel& robot_;
  std::string name_;
  control::Mode mode_ = control::Mode::kPassive;
  bool hanging_ = false, sitting_ = false;
};

void announce(const Arguments& arguments, const recording::RunInfo& run, Variant variant) {
  spdlog::info("pmg_controller {}: {} on {}, bundle {}, policy {}", recording::software_version(), run.robot,
               run.backend, run.bundle.substr(0, 12), run.policy);
  if (run.policy == "none") spdlog::warn("no policy: drives follow the reference, and nothing balances the robot");
  if (is_baseline(variant)) spdlog::warn("BASELINE {}: this policy is there for comparison", to_string(variant));
  spdlog::info("LCM {}, log {}{}", arguments.lcm_url, arguments.log.string(),
               arguments.no_log ? " (after a fault only)" : "");
  for (const std::string& refused : run.refused) spdlog::warn("NOT REAL-TIME: {}", refused);
}

/// Waits until somebody or something ends the run.
void supervise(runtime::Controller& controller, const EndSignals& signals, const Arguments& arguments,
               hal::Backend& backend, Console& console, const std::atomic<bool>& excitation_over) {
  hal::Window* const window = backend.window();
  constexpr long kPoll_ms = 20, kKeys_ms = 5;
  if (window != nullptr) window->show();
  const auto start = std::chrono::steady_clock::now();
  const auto expired = [&] {
    return arguments.duration_s &&
           std::chrono::steady_clock::now() - start >= std::chrono::duration<double>(*arguments.duration_s);
  };
  bool signalled = false;
  runtime::LatenessNews lateness;
  while (!signalled && !expired() && !excitation_over && controller.failure().empty()) {
    signalled = signals.wait_ms(window == nullptr ? kPoll_ms : kKeys_ms);
    for (runtime::ControllerNews news; controller.news(news);) console.show(news);
    if (const std::string news = backend.news(); !news.empty()) spdlog::warn("drives: {}", news);
    if (const std::string late = lateness.since(controller.turns()); !late.empty()) spdlog::warn("{}", late);
    if (window == nullptr) continue;
    window->listen();
    if (!window->closed()) continue;
    spdlog::info("the window was closed: velocity to zero first");
    return window->let_go();
  }
}

recording::RunInfo run_info(const Arguments& arguments, const control::LoadedControl& loaded,
                            const hal::Backend& backend, const runtime::Controller& controller,
                            const apps::ControllerExcitation& excitation) {
  return {.robot = arguments.name,
          .session = std::chrono::system_clock::now().time_since_epoch().count(),
          .policy = arguments.control.policy,
          .backend = arguments.backend.hal(),
          .options = config_json(arguments, loaded, backend, excitation).dump(),
          .bundle = loaded.bundle,
          .files = loaded.files,
          .realtime = controller.refused().empty(),
          .refused = controller.refused()};
}

/// What happens between the threads' start and their end; everything that input can spoil has been checked.
ExitCode run(const Arguments& arguments, const EndSignals& signals, runtime::Controller& controller,
             runtime::Comms& comms, std::optional<runtime::HeldClaim> claim, recording::Recorder& recorder,
             hal::Backend& backend, Console& console, const std::atomic<bool>& excitation_over) {
  std::string failure;
  try {
    const auto speak = [&] {
      claim.reset();  // STATUS says from now on whose the name is
      comms.step(kCommsWait_ms);
    };
    controller.start(speak, [&] { recorder.drain(); });
    spdlog::info("mode: passive");
    supervise(controller, signals, arguments, backend, console, excitation_over);
    failure = controller.failure();
    spdlog::info("{}: damping, then closing", failure.empty() ? "asked to end" : "can't run on");
    if (!controller.stop()) spdlog::error("the control thread did not confirm damping; the bus damped without it");
  } catch (const std::exception& error) {
    failure = error.what();
    controller.stop();  // before what its threads use goes away
  }
  recorder.close();
  if (!failure.empty()) spdlog::critical("{}", failure);
  if (!recorder.complete()) spdlog::critical("something is missing in the log");
  return failure.empty() && recorder.complete() ? kOk : kFailed;
}

void report(const Arguments& arguments, const runtime::Controller& controller, const recording::Recorder& recorder,
            const apps::Injection& injection) {
  for (const std::string& line : runtime::punctuality_lines(controller)) spdlog::info(line);
  if (recorder.lost() > 0) spdlog::warn("{} ticks are not in the log", recorder.lost());
  for (const std::string& line : injection.lines()) spdlog::info("injected: {}", line);
  if (!arguments.json) return;
  nlohmann::ordered_json json = {{"robot", arguments.name},
                                 {"log", arguments.log.string()},
                                 {"logged_ticks", recorder.written()},
                                 {"lost_ticks", recorder.lost()}};
  json.update(runtime::punctuality_json(controller));
  if (!arguments.inject.empty()) json["injected"] = injection.report();
  apps::print_json(json);
}

/// Fills in the arguments that follow from others.
void complete(Arguments& arguments, const model::RobotModel& robot) {
  if (arguments.name.empty()) arguments.name = robot.name;
  if (arguments.log.empty()) arguments.log = fs::path("out") / (arguments.name + "-" + utc_time());
  if (!arguments.log.has_filename()) arguments.log = arguments.log.parent_path();  // "out/first/" is out/first
  const fs::path asked = std::exchange(arguments.log, recording::run_folder(arguments.log));
  if (asked != arguments.log) {
    spdlog::warn("{} has the log of another run: this one's goes to {}", asked.string(), arguments.log.string());
  }
  arguments.lcm_url = io::choose_lcm_url(arguments.lcm_url);
  arguments.threads.realtime = !arguments.no_realtime;
}

int run_controller(Arguments& arguments) {
  const hal::BackendKind& kind = arguments.backend.kind();
  const hal::OptionValues backend_options = arguments.backend.values();
  if (arguments.benching() || arguments.exciting()) runtime::expect_no_policy(arguments.control);
  control::LoadedControl loaded = control::load_control(arguments.control);
  arguments.control.policy = loaded.policy_name;
  complete(arguments, loaded.robot);
  const io::WallClock clock;
  std::unique_ptr<hal::Backend> backend = kind.make({.robot = loaded.robot,
                                                     .clock = clock,
                                                     .name = arguments.name,
                                                     .lcm_url = arguments.lcm_url,
                                                     .benched_joint = arguments.bench,
                                                     .keeps_truth = !arguments.no_log,
                                                     .options = backend_options});
  backend = imu::with_imu(std::move(backend), loaded.robot, imu::sleeping());
  control::take_limits(backend->limits(), loaded.options);
  // What is injected is to be seen: a stall that the simulation waits for would be none.
  arguments.threads.waits = backend->limits().waits && arguments.inject.empty();
  apps::ControllerExcitation excitation(arguments.bench, arguments.excite, arguments.excitation, arguments.bench_out,
                                        backend->description().own_gains, loaded);
  apps::Injection injection(arguments.inject, arguments.backend.hal(), loaded.robot);
  injection.into(loaded);
  if (arguments.print_config) {
    apps::print_json(config_json(arguments, loaded, *backend, excitation));
    return kOk;
  }

  apps::see_doctor(arguments, loaded.robot, *backend);
  const EndSignals signals;
  seal::ControllerSeal seal = seal::load_controller_seal(arguments.keys, arguments.lcm_url, arguments.insecure);
  if (!seal.has_keys() && io::leaves_this_computer(arguments.lcm_url)) {
    spdlog::warn("INSECURE: without keys everybody who reaches {} can drive this robot", arguments.lcm_url);
  }
  const runtime::NameLock lock(arguments.name, arguments.lcm_url);
  io::LcmLink link(arguments.lcm_url);
  hal::Hal& drives = injection.into(backend->connect([&signals] { return signals.wait_ms(0); }), loaded.robot);
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, clock);
  runtime::Controller controller(loaded.robot, drives, *tick, arguments.threads);
  const recording::RunInfo info = run_info(arguments, loaded, *backend, controller, excitation);
  announce(arguments, info, loaded.variant);

  const double rate_Hz = 1.0 / loaded.options.dt_s;
  const auto warn = [](const std::string& text) { spdlog::warn("{}", text); };
  runtime::Comms comms(link, controller.inbox(), controller.outbox(), loaded.robot, info, rate_Hz, clock,
                       std::move(seal));
  comms.on_warning = warn;
  comms.work(backend->hoist());
  for (const std::string& other : comms.listen_for_others(kListen_s)) spdlog::info("also on this network: {}", other);
  std::optional<runtime::HeldClaim> claim(comms.hold_name());
  recording::Recorder recorder(controller.outbox(), loaded.robot, info, clock,
                               {.directory = arguments.log, .log = !arguments.no_log, .control_rate_Hz = rate_Hz},
                               warn);
  std::atomic<bool> excitation_over{false};
  recorder.after_record = [&](const control::TickRecord& record) {
    injection.watch(record);
    const hal::TruthSample* truth = backend->take_truth(record.state.bus_sample);
    if (truth != nullptr) recorder.write_truth(record.now_ns, truth->truth, truth->hoisted);
    if (const std::string news = excitation.take(record); !news.empty()) spdlog::info("{}", news);
    excitation_over = excitation.over();
  };
  Console console(loaded.robot, arguments.name);
  const ExitCode code =
      run(arguments, signals, controller, comms, std::move(claim), recorder, *backend, console, excitation_over);
  if (const std::string written = excitation.write(); !written.empty()) spdlog::info("{}", written);
  report(arguments, controller, recorder, injection);
  if (code == kOk && !excitation.whole()) return kFailed;
  return code;
}

}  // namespace

namespace pmg::apps {

int run_controller_program(int argc, char** argv, hal::BackendFactory backends) {
  CLI::App app("The controller on its own host: real-time threads, operators over LCM.", "pmg_controller");
  ControllerArguments arguments(std::move(backends));
  arguments.declare(app);
  const auto body = [&]() -> int {
    spdlog::set_default_logger(spdlog::stderr_color_mt("pmg"));
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<PlainMessage>('*').set_pattern("%H:%M:%S.%e %^%l%$ %*");
    spdlog::set_formatter(std::move(formatter));
    return run_controller(arguments);
  };
  return run_program(app, argc, argv, body, [&] { return control::told_bundle(arguments.control); });
}

}  // namespace pmg::apps
