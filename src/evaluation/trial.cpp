#include "evaluation/trial.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "hal/sil_hal.hpp"
#include "io/clock.hpp"
#include "runtime/lockstep.hpp"

namespace pmg::evaluation {

namespace {

constexpr double kTickPeriod_s = static_cast<double>(runtime::ControlCycle::kPeriod_ns) * 1e-9;

Errors errors_of(const runtime::TrackingSummary& tracking) {
  return {tracking.lin_vel_mae_m_s, tracking.yaw_vel_mae_rad_s, tracking.roll_mae_rad, tracking.pitch_mae_rad,
          tracking.height_mae_m};
}

/// MuJoCo 2.2.2's XML reader and error handlers are global.
std::unique_ptr<sim::World> build(const model::RobotModel& robot, const sim::WorldOptions& options) {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  return std::make_unique<sim::World>(robot, options);
}

/// The run's measure, and the same by step of the scenario.
class StepwiseMeasure {
 public:
  StepwiseMeasure(const model::RobotModel& robot, const runtime::Scenario& scenario)
      : measure_(robot.standing_height_m), scenario_(scenario) {}

  void add(const runtime::TickResult& result, const sim::Truth& truth, bool hoisted,
           const runtime::ScenarioStep& step) {
    if (&step != step_) close_step();
    step_ = &step;
    measure_.add(result, truth, hoisted, step.command);
  }

  /// What is left of a run whose simulation diverged: the robot counts as fallen.
  void count_as_fallen(double from_s, const runtime::TickResult& result, sim::Truth last) {
    last.p_WB.setZero();
    runtime::TickResult held = result;
    if (held.mode != runtime::Mode::kStand) held.mode = runtime::Mode::kWalk;
    for (double time_s = from_s; time_s < scenario_.duration_s() - 1e-9; time_s += kTickPeriod_s) {
      add(held, last, false, scenario_.at(time_s));
    }
  }

  runtime::RunOutcome outcome() const { return measure_.outcome(); }
  std::vector<Errors> take_step_errors() {
    close_step();
    return std::move(step_errors_);
  }

 private:
  void close_step() {
    if (step_ == nullptr) return;
    const runtime::TrackingSummary now = measure_.outcome().tracking;
    const double seconds = now.followed_s - before_.followed_s;
    const Errors sum = errors_of(now), sum_before = errors_of(before_);
    Errors mean;
    mean.fill(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t e = 0; e < kErrors && seconds > 0.5 * kTickPeriod_s; ++e) {
      mean[e] = (sum[e] * now.followed_s - sum_before[e] * before_.followed_s) / seconds;
    }
    step_errors_.push_back(mean);
    before_ = now;
  }

  runtime::RunMeasure measure_;
  const runtime::Scenario& scenario_;
  const runtime::ScenarioStep* step_ = nullptr;
  runtime::TrackingSummary before_;
  std::vector<Errors> step_errors_;
};

}  // namespace

TrialResult run_trial(const Candidate& candidate, const runtime::Scenario& scenario, const sim::WorldOptions& world,
                      const TrialOptions& options) {
  runtime::LoadedControl loaded = runtime::load_control(candidate.control);
  const model::RobotModel& robot = loaded.robot;
  sim::WorldOptions world_options = world;
  world_options.gantry = options.gantry;
  const std::unique_ptr<sim::World> simulated = build(robot, world_options);
  const io::WallClock stopwatch;
  const std::unique_ptr<runtime::Tick> tick = runtime::make_tick(loaded, stopwatch);
  hal::SilHal bus(*simulated);
  runtime::WorldPlant plant(*simulated);
  // Nobody carries a robot that is evaluated, whether or not a policy balances it.
  runtime::Lockstep lockstep(robot, bus, plant, *tick, scenario, nullptr,
                             {.balanced_by_policy = true, .always_hoisted = options.gantry});
  StepwiseMeasure measure(robot, scenario);
  bool ended = false, interrupted = false;
  sim::Truth truth;
  double next_s = 0.0;
  lockstep.after_tick = [&](const runtime::RunProgress& now) {
    truth = simulated->truth();
    measure.add(now.result, truth, options.gantry, now.step);
    next_s = now.time_s + kTickPeriod_s;
    if (options.observer) ended = !options.observer(now, *simulated);
  };
  lockstep.interrupted = [&] {
    interrupted = options.interrupted && options.interrupted();
    return ended || interrupted;
  };
  const bool diverged = lockstep.run().diverged;
  if (diverged) measure.count_as_fallen(next_s, tick->result(), truth);
  const runtime::RunOutcome outcome = measure.outcome();
  TrialResult result{.complete = !interrupted,
                     .fell = outcome.fell || diverged,
                     .fell_at_s = outcome.fell_at_s,
                     .faults = {},
                     .judged_s = outcome.tracking.followed_s,
                     .errors = errors_of(outcome.tracking),
                     .step_errors = measure.take_step_errors(),
                     .duration_s = outcome.duration_s};
  for (const runtime::Fault& fault : outcome.faults) result.faults.push_back(runtime::describe(fault, robot));
  return result;
}

}  // namespace pmg::evaluation
