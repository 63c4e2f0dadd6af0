#include "sil_play.hpp"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <optional>

#include "io/lcm_link.hpp"
#include "io/plain_text.hpp"
#include "progress_line.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_log.hpp"
#include "runtime/comms.hpp"
#include "runtime/controller_report.hpp"
#include "sil/film.hpp"
#include "sil/realtime_run.hpp"
#include "sil/run_text.hpp"
#include "sil/sil_hal.hpp"

namespace pmg::apps {

namespace {

recording::RunInfo run_info(const Stage& stage) {
  nlohmann::ordered_json options = config_json(stage.arguments, stage.loaded, stage.bench);
  options["set_on_simulator"] = stage.world.set_values();
  return {.robot = stage.loaded.robot.name,
          .policy = stage.arguments.control.policy,
          .options = options.dump(),
          .bundle = stage.loaded.bundle,
          .files = stage.loaded.files};
}

/// The controller's network for operators, in place of a scenario.
class Operators {
 public:
  /// Keeps references. Throws std::runtime_error if there is no such network, or another controller with this
  /// name on it.
  Operators(const Stage& stage, const recording::RunInfo& info, runtime::Controller& controller,
            sil::SimulatedRobot& simulated)
      : lock_(info.robot, io::choose_lcm_url(stage.arguments.lcm_url)),
        link_(io::choose_lcm_url(stage.arguments.lcm_url)),
        comms_(link_, controller.inbox(), controller.outbox(), stage.loaded.robot, info,
               1.0 / stage.loaded.options.dt_s, clock_) {
    constexpr double kListen_s = 0.5;  // fifty STATUS messages of another controller
    comms_.work(simulated.hoist_line());
    comms_.on_warning = [](const std::string& text) { std::cerr << io::plain_text(text) << '\n'; };
    comms_.listen_for_others(kListen_s, [] { return interrupt_requested != 0; });
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

}  // namespace

Played play_lockstep(const Stage& stage) {
  const model::RobotModel& robot = stage.loaded.robot;
  const double rate_Hz = 1.0 / stage.loaded.options.dt_s;
  sil::SilHal drives(stage.world);
  sil::FailingBus bus(drives, stage.failures, robot, stage.failure_clock, false);
  sil::WorldPlant plant(stage.world);
  recording::TickLog log(stage.log_file, robot, run_info(stage), rate_Hz);
  std::optional<sil::Film> film;
  if (stage.arguments.video) film.emplace(stage.world, stage.arguments.out / "video.mp4");
  ProgressLine progress;
  sil::Lockstep lockstep(robot, bus, plant, stage.tick, stage.scenario, &log,
                         {.balanced_by_policy = stage.balanced_by_policy(), .always_hoisted = stage.arguments.gantry});
  lockstep.interrupted = [&stage] { return stage.over(); };
  if (!stage.failures.empty()) {
    lockstep.bus_sleeps = [&bus] { return bus.bus_sleeps(); };
    lockstep.control_sleeps = [&bus] { return bus.control_sleeps(); };
    lockstep.overrun_s = [&bus] { return bus.overrun_s(); };
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

Played play_realtime(const Stage& stage) {
  const model::RobotModel& robot = stage.loaded.robot;
  const double rate_Hz = 1.0 / stage.loaded.options.dt_s;
  sil::SimulatedRobot simulated(stage.world,
                                stage.arguments.gantry           ? sil::HoistedBy::kGantry
                                : stage.arguments.by_operators() ? sil::HoistedBy::kCrane
                                                                 : sil::HoistedBy::kScenario,
                                true);
  sil::FailingBus bus(simulated, stage.failures, robot, stage.failure_clock, true);
  runtime::Controller controller(robot, bus, stage.tick, {.waits = stage.failures.empty()});
  for (const std::string& refused : controller.refused()) std::cerr << "not real-time: " << refused << '\n';
  recording::RunInfo info = run_info(stage);
  info.session = std::chrono::system_clock::now().time_since_epoch().count();
  info.realtime = controller.refused().empty();
  info.refused = controller.refused();
  recording::TickLog log(stage.log_file, robot, info, rate_Hz);
  ProgressLine progress;
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

}  // namespace pmg::apps
