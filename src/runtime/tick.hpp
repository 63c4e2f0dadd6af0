// One control tick, 100 Hz: command -> supervisor -> generator -> GCO -> policy -> limiter -> drives. The same object
// runs in lockstep with a simulation and in the robot's control thread.
#pragma once

#include <cstdint>
#include <memory>

#include "gco/ground_aware_command.hpp"
#include "hal/hal.hpp"
#include "io/clock.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/generator.hpp"
#include "policy/policy.hpp"
#include "runtime/command_intake.hpp"
#include "runtime/entry_ramp.hpp"
#include "runtime/limiter.hpp"
#include "runtime/mode.hpp"
#include "runtime/supervisor.hpp"

namespace pmg::runtime {

struct TickOptions {
  double dt_s = 0.01;
  GeneratorOptions generator;
  gco::Options gco;
  SupervisorOptions supervisor;
  LimiterOptions limiter;
  EntryRampOptions entry;
};

/// The options that robot.yaml decides: command limits and scales; defaults for the rest.
TickOptions tick_options(const model::RobotModel& robot);

struct TickInput {
  const model::RobotState& state;
  hal::BusStatus bus = hal::BusStatus::kOk;
  std::int64_t now_ns = 0;              ///< by the clock that stamps the state
  const DriveMessage* drive = nullptr;  ///< what arrived since the last tick, if anything
  const ModeRequest* request = nullptr;
};

/// Wall time that each stage took, by the stopwatch.
struct StageTimes {
  std::int64_t tick_ns = 0, generator_ns = 0, gco_ns = 0, policy_ns = 0;
};

struct TickResult {
  model::JointCommand command;  ///< acts from the next bus cycle on
  Mode mode = Mode::kPassive;
  Fault fault;            ///< kNone unless mode is kFault
  Command user;           ///< the driving source's command as far as the mode admits it
  Reference reference;    ///< of this tick in Stand and Walk; otherwise of the last such tick
  gco::Result optimised;  ///< likewise
  LimitReport limited;
  double command_age_s = 0.0;  ///< infinite before the first command
  Source driving;              ///< empty when nobody drives
  ModeRequest last_request;    ///< the last one received, whether followed or not: the acknowledgement
  StageTimes times;
};

class Tick {
 public:
  /// Keeps a reference to the stopwatch. Throws std::invalid_argument when library and robot don't fit together.
  Tick(const model::RobotModel& robot, ClipLibrary library, std::unique_ptr<policy::Policy> policy,
       const io::Clock& stopwatch, const TickOptions& options);

  /// No exception, no lock, no I/O; no heap but the policy's own.
  const TickResult& step(const TickInput& input) noexcept;
  const TickResult& result() const noexcept { return result_; }

 private:
  void take_messages(const TickInput& input) noexcept;
  void enter_stand(const model::RobotState& state) noexcept;
  /// False when the policy failed; the fault is then latched and the command is not filled.
  bool drive(const TickInput& input) noexcept;
  void release(const model::RobotState& state, bool brake) noexcept;

  const io::Clock& stopwatch_;
  double dt_s_;
  JointVector kp_, kd_;
  Generator generator_;
  gco::GroundAwareCommand gco_;
  std::unique_ptr<policy::Policy> policy_;
  CommandIntake intake_;
  Supervisor supervisor_;
  EntryRamp entry_;
  Limiter limiter_;
  TickResult result_;
};

}  // namespace pmg::runtime
