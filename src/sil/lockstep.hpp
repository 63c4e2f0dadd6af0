// The controller and a simulation in one thread: one bus step per 2 ms of simulation, one control tick per five.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "control/control_cycle.hpp"
#include "control/tick.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"
#include "model/robot_model.hpp"
#include "recording/tick_log.hpp"
#include "sil/hoist.hpp"
#include "sil/plant.hpp"
#include "sil/run_measure.hpp"
#include "sil/scenario.hpp"
#include "sil/scenario_log.hpp"
#include "sil/stage_timing.hpp"

namespace pmg::sil {

struct LockstepOptions {
  bool balanced_by_policy = false;  ///< then the gantry stays away once the policy has the drives
  bool always_hoisted = false;      ///< the world began on the gantry and stays there
};

/// (world, command) => the world one control tick later: the drives hold this command for the bus cycles of a tick.
void hold_for_one_tick(sim::World& world, const model::JointCommand& command) noexcept;

class Lockstep {
 public:
  /// Keeps references to all of them. log may be null.
  Lockstep(const model::RobotModel& robot, hal::Hal& bus, Plant& plant, control::Tick& tick, const Scenario& scenario,
           recording::TickLog* log, const LockstepOptions& options);

  /// Called after every tick, for progress and pictures.
  std::function<void(const RunProgress&)> after_tick;
  /// Called after every tick, with all of it.
  std::function<void(const control::TickRecord&)> after_record;
  /// Asked before every tick, with the time since the run's begin [s]: what the scenario's operator wants of the arms.
  /// Its sender, times and lease are filled in.
  std::function<std::optional<arms::PerArm<control::ArmTarget>>(double)> lead_arms;
  /// In cycles in which its thread sleeps, a cycle is left out. While the bus sleeps the world goes on without it.
  std::function<bool()> bus_sleeps, control_sleeps;
  std::function<void()> while_bus_sleeps;
  /// How much later than its deadline the tick ends [s].
  std::function<double()> overrun_s;
  /// Asked before every tick: true ends the run and keeps what was done.
  std::function<bool()> interrupted;

  /// Plays the scenario once. A command computed from bus sample k acts from bus step k + 1.
  RunOutcome run();

  const StageTiming& timing() const { return timing_; }

 private:
  void advance();
  void control(double time_s);
  Support support() noexcept;
  void measure(double time_s);

  Plant& plant_;
  control::Tick& tick_;
  const Scenario& scenario_;
  recording::TickLog* log_;
  std::optional<ScenarioLog> scenario_log_;
  LockstepOptions options_;
  io::SimulationClock clock_;
  hal::BusLink link_;
  control::OperatorInbox inbox_;
  hal::BusCycle bus_cycle_;
  control::ControlCycle control_cycle_;
  ScenarioPlayer player_;
  Hoist hoist_;
  bool balanced_ = false;  // the policy had the drives
  RunMeasure measure_;
  StageTiming timing_;
};

}  // namespace pmg::sil
