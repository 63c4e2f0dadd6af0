// The controller and a simulation in one thread: one bus step per 2 ms of simulation, one control tick per five.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gco/slip_statistics.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"
#include "model/robot_model.hpp"
#include "runtime/control_cycle.hpp"
#include "runtime/hoist.hpp"
#include "runtime/metrics.hpp"
#include "runtime/plant.hpp"
#include "runtime/scenario.hpp"
#include "runtime/stage_timing.hpp"
#include "runtime/tick.hpp"
#include "runtime/tick_log.hpp"

namespace pmg::runtime {

struct LockstepOptions {
  bool balanced_by_policy = false;  ///< then the gantry stays away
  bool always_hoisted = false;      ///< the world began on the gantry and stays there
};

/// How a run ended and what was measured on the way.
struct LockstepOutcome {
  double duration_s = 0.0;  ///< simulated
  double hoisted_s = 0.0;
  bool interrupted = false;
  bool diverged = false;  ///< the simulation blew up; the run ends there
  bool fell = false;
  double fell_at_s = -1.0;
  std::vector<Fault> faults;
  TrackingSummary tracking;
  gco::SlipSummary reference_slip;
};

/// What an observer sees after each tick.
struct LockstepProgress {
  double time_s;
  double duration_s;
  const ScenarioStep& step;
  const TickResult& result;
};

class Lockstep {
 public:
  /// Keeps references to all of them. log may be null.
  Lockstep(const model::RobotModel& robot, hal::Hal& bus, Plant& plant, Tick& tick, const Scenario& scenario,
           TickLog* log, const LockstepOptions& options);

  /// Called after every tick, for progress and pictures.
  std::function<void(const LockstepProgress&)> after_tick;
  /// Asked before every tick: true ends the run and keeps what was done.
  std::function<bool()> interrupted;

  /// Plays the scenario once. A command computed from bus sample k acts from bus step k + 1.
  LockstepOutcome run();

  const StageTiming& timing() const { return timing_; }

 private:
  void advance();
  void control(double time_s);
  void measure(double time_s);

  Plant& plant_;
  Tick& tick_;
  const Scenario& scenario_;
  TickLog* log_;
  LockstepOptions options_;
  io::SimulationClock clock_;
  hal::BusLink link_;
  OperatorInbox inbox_;
  hal::BusCycle bus_cycle_;
  ControlCycle control_cycle_;
  ScenarioPlayer player_;
  Hoist hoist_;
  Metrics metrics_;
  gco::SlipStatistics slip_;
  StageTiming timing_;
  double gait_period_s_;
  LockstepOutcome outcome_;
};

}  // namespace pmg::runtime
