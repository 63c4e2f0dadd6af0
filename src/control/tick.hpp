// One control tick, 100 Hz: command -> supervisor -> generator -> GCO -> policy -> limiter -> drives. The robot's
// control thread and lockstep run the same object.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "control/command_intake.hpp"
#include "control/entry_ramp.hpp"
#include "control/excitation_player.hpp"
#include "control/fallback_reference.hpp"
#include "control/led_arms.hpp"
#include "control/limiter.hpp"
#include "control/mode.hpp"
#include "control/robot_excitation_player.hpp"
#include "control/sit_down.hpp"
#include "control/supervisor.hpp"
#include "control/target_maker.hpp"
#include "control/velocity_trim.hpp"
#include "faults/action_monitor.hpp"
#include "faults/foot_load_watch.hpp"
#include "gco/motion_composition.hpp"
#include "hal/command_guard.hpp"
#include "hal/hal.hpp"
#include "io/clock.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "policy/policy.hpp"

namespace pmg::control {

struct TickResult;

/// Spoils what a tick itself makes, in simulations and tests: the causes that no bus and no policy can have.
class TickSpoiler {
 public:
  virtual ~TickSpoiler() = default;
  virtual void spoil(Reference& reference) noexcept = 0;  ///< of this tick
  virtual void spoil(TickResult& result) noexcept = 0;    ///< at the tick's end
};

/// Before a policy that balances gets the drives, it runs unsent beside the reference.
struct RehearsalOptions {
  double duration_s = 0.5;  ///< for so long at least; 0: it gets them unseen
  /// Largest step of a joint from the reference, which is sent, to what the policy wants when it gets the drives.
  double largest_step_rad = 0.5;
  int refused_ticks = 5;  ///< so many ticks in a row beyond it, on the ground, are a fault
};

struct TickOptions {
  double dt_s = 0.01;
  GeneratorOptions generator;
  gco::Options gco;
  SupervisorOptions supervisor;
  LimiterOptions limiter;
  hal::GuardOptions guard;  ///< of the bus that this tick's commands go to
  EntryRampOptions entry;
  std::optional<arms::ArmSetup> arms{};  ///< nothing: the reference alone moves the arms
  faults::FootLoadOptions foot_load;
  /// From the policy's targets to the reference when the robot begins to hang, and back when it stands again: quick,
  /// because a robot that is set down must be balanced.
  EntryRampOptions change_over{.speed_rad_s = 3.0, .shortest_s = 0.2, .longest_s = 0.5};
  RehearsalOptions rehearsal;
  VelocityTrimOptions velocity_trim;
  faults::ActionMonitorOptions action_monitor;
  SitDownOptions sit_down;
  /// In Stand one joint is excited once while the others hold; nothing walks then. Only where no policy balances.
  std::optional<ExcitationPlan> excitation{};
  std::optional<RobotExcitationPlan> robot_excitation{};  ///< the same of all joints at once; not both
  TickSpoiler* spoiler = nullptr;
  int late_policy_ticks = 3;  ///< after so many ticks in a row without a result of the policy: a fault; before, its
                              ///< last target is held
};

/// The options that robot.yaml decides: command limits and scales; defaults for the rest.
TickOptions tick_options(const model::RobotModel& robot);

struct TickInput {
  const model::RobotState& state;
  hal::BusStatus bus = hal::BusStatus::kOk;
  std::int64_t now_ns = 0;                ///< by the clock that stamps the state
  std::span<const DriveMessage> drives;   ///< what arrived since the last tick, in its order; at most kMaxDrives
  std::span<const ModeRequest> requests;  ///< likewise, at most kMaxRequests
  std::span<const ArmsMessage> arms{};    ///< likewise, at most kMaxArms
  bool stop = false;                      ///< the stop line was pulled since the last tick
  hal::TripCause guard_trip = hal::TripCause::kNone;  ///< the bus guard took over since the last tick
  std::int64_t late_ns = 0;  ///< how far behind its deadline the last tick ended; not positive: in time
  bool policy_late = false;  ///< the last tick ended behind its deadline, and its policy alone took longer than a tick
};

/// Messages that one tick takes; the operator's inbox keeps the rest for the next.
inline constexpr std::size_t kMaxDrives = 32, kMaxRequests = 8, kMaxArms = 12;

/// Wall time that each stage took, by the stopwatch.
struct StageTimes {
  std::int64_t tick_ns = 0, generator_ns = 0, gco_ns = 0, policy_ns = 0;
};

/// What is known of led arms after a tick.
struct ArmsState {
  bool there = false;  ///< the robot has arms that can be led
  ArmsOrder order = ArmsOrder::kNoneCame;
  Source source;  ///< of the last accepted message; empty before the first
  std::int64_t sequence = 0;
  std::int64_t refused = 0;                                                      ///< messages since the start
  CommandIntake::DriveVerdict refusal = CommandIntake::DriveVerdict::kAccepted;  ///< of the last of them
  arms::PerArm<arms::ArmReport> arm{};
};

/// Something else than the reference has an arm.
inline bool led(const ArmsState& state) noexcept {
  constexpr arms::ArmActivity kFree = arms::ArmActivity::kReference;
  return state.arm[kLeft].activity != kFree || state.arm[kRight].activity != kFree;
}

struct TickResult {
  model::JointCommand command;  ///< acts from the next bus cycle on
  Mode mode = Mode::kPassive;
  faults::Fault fault;                       ///< kNone unless mode is kFault
  ArmsState arms;                            ///< what an operator's targets do
  Command user;                              ///< the driving source's command as far as the mode admits it
  Reference reference;                       ///< of this tick in Stand and Walk; otherwise of the last such tick
  gco::Result optimised;                     ///< likewise; its command is what the policy observes
  ExcitationProgress excitation;             ///< the run and sample of the command
  bool entering = false;                     ///< in Stand: the ramp from the measured posture is not over
  bool policy_held = false;                  ///< the policy gave no result for this tick: its last target is in force
  TargetMaker maker = TargetMaker::kNobody;  ///< who made the command's positions
  /// Load of each foot over the robot's weight; nullopt before Stand, and with a policy that needs no ground.
  std::optional<PerFoot<double>> foot_load;
  LimitReport limited;
  IgnoredCommands ignored;                 ///< operators' messages since the start, by what became of them
  double command_age_s = 0.0;              ///< infinite before the first command
  Source driving;                          ///< empty when nobody drives
  std::array<ModeAck, kMaxRequests> acks;  ///< answers: one for each of this tick's requests
  std::size_t ack_count = 0;
  std::int64_t late_ticks = 0;  ///< since the start, that ended behind their deadline
  StageTimes times;
};

class Tick {
 public:
  /// Keeps a reference to the stopwatch, whose times are reported and decide nothing. Throws std::invalid_argument when
  /// library, policy and robot don't fit together.
  Tick(const model::RobotModel& robot, const ClipLibrary& library, std::unique_ptr<policy::Policy> policy,
       const io::Clock& stopwatch, const TickOptions& options);

  /// (state, operators' messages, timing) => (joint command, mode, answers). No exception, no lock, no I/O; no heap but
  /// the policy's own.
  const TickResult& step(const TickInput& input) noexcept;
  const TickResult& result() const noexcept { return result_; }
  /// The bus takes its guard's options from here: the gains of this tick were checked against them.
  const hal::GuardOptions& guard() const noexcept { return guard_; }

 private:
  void take_messages(const TickInput& input) noexcept;
  SupervisorInput supervisor_input(const TickInput& input) const noexcept;
  void watch_feet(const model::RobotState& state) noexcept;
  void enter_stand(const model::RobotState& state) noexcept;
  void hang() noexcept;
  void take_over() noexcept;
  /// True if it changes the maker.
  bool take(TargetEvent event) noexcept;
  void begin_rehearsal() noexcept;
  /// The policy's targets of this tick, unsent; on the ground it is given the drives, or refused.
  faults::Fault rehearse(const model::RobotState& state) noexcept;
  faults::Fault judge_first_step() noexcept;
  void begin_policy() noexcept;
  /// (state) => (command): reference, ground-aware command, policy, limits. With a fault the command is not filled.
  /// Called again in a tick whose policy failed: the reference goes on once a tick.
  faults::Fault drive(const model::RobotState& state) noexcept;
  faults::Fault make_reference(const model::RobotState& state) noexcept;
  void reset_motion() noexcept;
  /// (the generator's reference) => (with arms where the operator has them).
  void lead_arms() noexcept;
  /// The generator gave no finite reference: a fault; a sit-down goes on with the fallback reference.
  faults::Fault without_generator() noexcept;
  void excite(model::JointCommand& command) noexcept;
  void excite_joint(model::JointCommand& command) noexcept;
  bool excites() const noexcept { return excitation_ || robot_excitation_; }
  void take_excitation(const model::RobotModel& robot, const TickOptions& options);
  void see_excitation() noexcept;
  faults::Fault ask_policy(const model::RobotState& state) noexcept;
  faults::Fault make_target(const model::RobotState& state) noexcept;
  policy::Status act(const model::RobotState& state, JointVector& q_des) noexcept;
  bool sound(policy::Status status, const JointVector& q_des) const noexcept;
  /// In Fault: begins, goes on with or ends the sit-down. True if it made this tick's command.
  bool sit_down(const TickInput& input, Mode before) noexcept;
  void begin_sit_down(const TickInput& input) noexcept;
  /// One tick of the sit-down's first stage; false when it is over or can't go on.
  bool lower_reference(const TickInput& input) noexcept;
  /// The reference goes on alone, under robot.yaml's gains.
  void leave_policy(const model::RobotState& state) noexcept;
  const policy::DriveGains& gains_in_use() const noexcept {
    return result_.maker == TargetMaker::kLoweredByReference ? sit_down_.gains() : gains_;
  }
  faults::FaultEvidence evidence(const TickInput& input) const noexcept;
  void set_limiter_gains(const policy::DriveGains& gains) noexcept;
  void release(const model::RobotState& state, std::int64_t now_ns) noexcept;

  const io::Clock& stopwatch_;
  double dt_s_;
  int policy_may_owe_ticks_;
  TickSpoiler* spoiler_;
  hal::GuardOptions guard_;
  policy::DriveGains gains_;
  JointVector brake_kd_;
  gco::MotionComposition motion_;
  std::optional<VelocityTrim> velocity_trim_;  // nothing: the policy doesn't observe what is asked of its clips
  std::unique_ptr<policy::Policy> policy_;
  CommandIntake intake_;
  Supervisor supervisor_;
  std::optional<faults::FootLoadWatch> feet_;  // nothing for a policy that needs no ground
  EntryRamp entry_, change_over_, hand_over_;  // hand_over_: from the reference to a policy that becomes known
  std::optional<LedArms> arms_;                // nothing: of a robot without
  std::optional<ExcitationPlayer> excitation_;
  std::optional<RobotExcitationPlayer> robot_excitation_;
  Limiter limiter_;
  RehearsalOptions rehearsal_;
  faults::ActionMonitor action_monitor_;
  SitDown sit_down_;
  FallbackReference fallback_;      // in a sit-down whose generator has failed
  Reference good_reference_;        // the last finite one
  Command good_observed_;           // u' with it
  bool stop_asked_ = false;         // in this tick, by anybody
  bool reference_is_made_ = false;  // in this tick, with led arms
  JointVector target_;              // the policy's last good one, before ramp and limits
  int policy_owes_ticks_ = 0, gco_held_ticks_ = 0;
  JointVector rehearsed_;  // the policy's last unsent targets
  int rehearsed_ticks_ = 0, refused_ticks_ = 0;
  TickResult result_;
};

}  // namespace pmg::control
