// A scenario played to the threaded controller of a simulated robot, as an operator would, by the wall clock; or
// operators themselves.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "io/clock.hpp"
#include "recording/tick_log.hpp"
#include "runtime/controller.hpp"
#include "sil/run_measure.hpp"
#include "sil/scenario.hpp"
#include "sil/scenario_log.hpp"
#include "sil/simulated_robot.hpp"
#include "sil/stage_timing.hpp"

namespace pmg::sil {

class RealtimeRun {
 public:
  /// Keeps references. robot keeps the truth. log may be null. hoists: the scenario's gantry acts (nobody balances the
  /// robot, and it does not hang already).
  RealtimeRun(const model::RobotModel& model, SimulatedRobot& robot, runtime::Controller& controller,
              const Scenario& scenario, recording::TickLog* log, bool hoists);

  /// Called after every tick, in the recorder's thread.
  std::function<void(const RunProgress&)> after_tick;
  /// One pass of the operators' thread in place of the scenario, which then only names the run.
  std::function<void()> operators;
  /// Asked some fifty times a second: true ends the run and keeps what was done.
  std::function<bool()> interrupted;

  /// Plays the scenario once and stops the controller; times in the outcome count from the first tick. Throws
  /// std::runtime_error when a thread failed or the drives don't answer.
  RunOutcome run();

  const StageTiming& timing() const { return timing_; }

 private:
  void speak();   // the operator's pass: one message each 10 ms
  void record();  // the recorder's pass
  void record_tick();

  SimulatedRobot& robot_;
  runtime::Controller& controller_;
  const Scenario& scenario_;
  recording::TickLog* log_;
  std::optional<ScenarioLog> scenario_log_;
  const bool hoists_;
  const io::WallClock clock_;

  // the operator's thread
  ScenarioPlayer player_;
  std::int64_t start_ns_ = 0, next_ns_ = 0;
  std::atomic<bool> spoken_{false};
  std::atomic<std::size_t> spoken_step_{0};  // number of the scenario's step in force; 0 before the first word

  // the recorder's thread
  RunMeasure measure_;
  StageTiming timing_;
  control::TickRecord record_;
  recording::BusTiming bus_;
  recording::BusCycleReader bus_cycles_;
  Command asked_;
  std::int64_t ticks_ = 0, first_tick_ns_ = 0;
  std::atomic<bool> measuring_{true};  // damping at the end is no part of the run
};

}  // namespace pmg::sil
