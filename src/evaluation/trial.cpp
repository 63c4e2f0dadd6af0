#include "evaluation/trial.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "evaluation/step_measure.hpp"
#include "io/clock.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"

namespace pmg::evaluation {

TrialResult run_trial(const Candidate& candidate, const sil::Scenario& scenario, const sim::WorldOptions& world,
                      const TrialOptions& options) {
  control::LoadedControl loaded = control::load_control(candidate.control);
  const model::RobotModel& robot = loaded.robot;
  sim::WorldOptions world_options = world;
  world_options.gantry = options.gantry;
  sim::World simulated(robot, world_options);
  const io::WallClock stopwatch;
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, stopwatch);
  sil::SilHal bus(simulated);
  sil::WorldPlant plant(simulated);
  // The gantry never carries the robot, whether or not a policy balances it.
  sil::Lockstep lockstep(robot, bus, plant, *tick, scenario, nullptr,
                         {.balanced_by_policy = true, .always_hoisted = options.gantry});
  StepMeasure measure(robot, scenario);
  bool ended = false, interrupted = false;
  model::GroundTruth truth;
  double next_s = 0.0;
  lockstep.after_tick = [&](const sil::RunProgress& now) {
    truth = simulated.truth();
    measure.add(now.time_s, now.result, truth, options.gantry, now.step);
    next_s = now.time_s + control::ControlCycle::kPeriod_s;
    if (options.observer) ended = !options.observer(now, simulated);
  };
  lockstep.interrupted = [&] {
    interrupted = options.progress.interrupted_now();
    return ended || interrupted;
  };
  const bool diverged = lockstep.run().diverged;
  if (diverged) measure.count_as_fallen(next_s, tick->result(), truth);
  const sil::RunOutcome outcome = measure.outcome();
  TrialResult result;
  result.complete = !interrupted;
  result.fell = outcome.fell || diverged;
  result.fell_at_s = outcome.fell_at_s;
  result.duration_s = outcome.duration_s;
  measure.report(result);
  for (const faults::Fault& fault : outcome.faults) result.faults.push_back(faults::describe(fault, robot));
  return result;
}

}  // namespace pmg::evaluation
