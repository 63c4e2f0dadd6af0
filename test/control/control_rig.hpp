// The robot's bus cycle, control cycle and tick in one thread on a virtual clock, with drives that follow at once.
// Everything can be stalled, corrupted and silenced.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "control/control_cycle.hpp"
#include "control/fixtures.hpp"
#include "control/operator_inbox.hpp"
#include "hal/bus_cycle.hpp"
#include "runtime/periodic_schedule.hpp"

namespace pmg::test {

/// Drives that follow at once; a test can corrupt their report.
class SpoiltBus final : public hal::Hal {
 public:
  explicit SpoiltBus(const model::RobotModel& robot) : feet_(robot), state_(standing_state(robot)) {}

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    last_command = command;
    ++exchanges;
    if (command.kp.sum() > 0.0) state_.q = command.q;
    feet_.apply(carried, state_);
    if (status != hal::BusStatus::kOk) return status;
    state_.bus_sample += 1;
    state = state_;
    if (spoil) spoil(state);
    return status;
  }

  /// The drives' command is to brake: no stiffness, some damping.
  bool damping() const { return last_command.kp.cwiseAbs().maxCoeff() == 0.0 && last_command.kd.minCoeff() > 0.0; }
  bool finite() const {
    for (const JointVector* values :
         {&last_command.q, &last_command.dq, &last_command.kp, &last_command.kd, &last_command.tau_ff}) {
      if (!values->allFinite() || values->size() != state_.q.size()) return false;
    }
    return true;
  }

  hal::BusStatus status = hal::BusStatus::kOk;
  PerFoot<double> carried{0.5, 0.5};  ///< share of the weight, by foot
  std::function<void(model::RobotState&)> spoil;
  model::JointCommand last_command;
  int exchanges = 0;

 private:
  LoadedFeet feet_;
  model::RobotState state_;
};

class ControlRig {
 public:
  /// balances: false for the robot of `--policy none`.
  explicit ControlRig(const model::RobotModel& robot, bool balances = true)
      : ControlRig(robot, clips(robot), control::tick_options(robot), balances) {}
  ControlRig(const model::RobotModel& robot, ClipLibrary library, const control::TickOptions& options,
             bool balances = true)
      : bus(robot),
        policy(new BreakablePolicy(balances)),
        inbox(link.stop),
        tick(robot, library, std::unique_ptr<policy::Policy>(policy), clock, options),
        bus_cycle(bus, link, robot, clock),
        control_cycle(tick, link, inbox, clock) {
    drive.source = control::Source::make("operator", 1);
    drive.lease_s = 0.5;
  }
  ControlRig(const ControlRig&) = delete;
  ControlRig& operator=(const ControlRig&) = delete;

  /// 2 ms of the world, and the control cycle when it is due.
  void cycle() {
    world();
    wake_control();
  }
  /// The control cycle, when it is due: on the schedule of the robot's thread.
  void wake_control() {
    const std::int64_t woke_ns = clock.now_ns();
    if (woke_ns < schedule_.planned_ns() + control_delay_cycles * hal::BusCycle::kPeriod_ns) return;
    if (!silent) speak();
    if (!control_frozen) control_cycle.run(schedule_.planned_ns());
    schedule_.advance(woke_ns, clock.now_ns());
  }
  /// 2 ms of the world without the control thread, which is busy or asleep.
  void world() {
    clock.advance_to(clock.now_ns() + hal::BusCycle::kPeriod_ns);
    if (!bus_frozen) bus_cycle.run();
    ++cycles;
    if (after_cycle) after_cycle();
  }
  void run(double duration_s) {
    for (long k = 0; k < std::lround(duration_s * 500.0); ++k) cycle();
  }
  /// Runs until this number of cycles after a tick.
  void align(int cycles_after_tick) {
    while (cycles % 5 != cycles_after_tick) cycle();
  }

  void ask(control::Mode mode) { ask(drive.source, mode, false); }
  void reset() { ask(drive.source, control::Mode::kDamping, true); }
  void ask(const control::Source& source, control::Mode mode, bool reset_fault) {
    inbox.put(control::ModeRequest{.source = source,
                                   .sequence = ++request_sequence_,
                                   .stamp_ns = clock.now_ns(),
                                   .received_ns = clock.now_ns(),
                                   .mode = mode,
                                   .reset_fault = reset_fault});
  }
  /// Walks on the spot, with all ramps done.
  void reach_walk() {
    ask(control::Mode::kWalk);
    for (int k = 0; k < 60 && mode() != control::Mode::kWalk; ++k) run(0.1);  // the ramp takes at most 5 s
    ASSERT_EQ(mode(), control::Mode::kWalk);
    run(0.5);
  }

  /// Bus cycles from the first one after inject() to the drives' first command of a sit-down, and to their first
  /// damping command; -1: none within two seconds.
  struct Reaction {
    int to_sit_down = -1, to_damping = -1;
  };
  Reaction reaction_to(const std::function<void()>& inject) {
    const int first_cycle = cycles + 1;
    inject();
    Reaction reaction;
    after_cycle = [&] {
      if (reaction.to_damping >= 0) return;
      if (bus.damping()) reaction.to_damping = cycles - first_cycle;
      if (reaction.to_sit_down < 0 && sits()) reaction.to_sit_down = cycles - first_cycle;
    };
    for (int k = 0; k < 1000 && reaction.to_damping < 0; ++k) cycle();
    after_cycle = nullptr;
    return reaction;
  }
  int cycles_to_damping(const std::function<void()>& inject) { return reaction_to(inject).to_damping; }

  /// The drives' last command lowers the robot.
  bool sits() const {
    const control::TickResult& result = tick.result();
    return control::sitting_down(result.maker) && bus.last_command.bus_sample == result.command.bus_sample;
  }

  control::Mode mode() const { return tick.result().mode; }
  faults::FaultCode fault() const { return tick.result().fault.code; }

  io::SimulationClock clock;
  hal::BusLink link;
  SpoiltBus bus;
  BreakablePolicy* policy;
  control::OperatorInbox inbox;
  control::Tick tick;
  hal::BusCycle bus_cycle;
  control::ControlCycle control_cycle;
  control::DriveMessage drive;  ///< sent before every tick
  std::function<void()> after_cycle;
  bool bus_frozen = false, control_frozen = false, silent = false;
  int control_delay_cycles = 0;  ///< delay of the control thread's wake-up
  int cycles = 0;                ///< of 2 ms, since the start

 private:
  void speak() {
    ++drive.sequence;
    drive.stamp_ns = drive.received_ns = clock.now_ns();
    inbox.put(drive);
  }

  runtime::PeriodicSchedule schedule_{control::ControlCycle::kPeriod_ns, control::ControlCycle::kPeriod_ns};
  std::int64_t request_sequence_ = 0;
};

}  // namespace pmg::test
