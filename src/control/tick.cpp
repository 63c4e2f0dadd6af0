#include "control/tick.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "control/drive_gains.hpp"
#include "control/released_command.hpp"

namespace pmg::control {

namespace {

faults::ActionMonitorOptions monitor_options(faults::ActionMonitorOptions options, const policy::Policy& policy) {
  options.bound_rad = policy.action_bound_rad().value_or(options.bound_rad);
  return options;
}

bool finite(const Command& command) noexcept {
  return std::ranges::all_of(command.u, [](double value) { return std::isfinite(value); });
}

bool finite(const Reference& reference) noexcept {
  return reference.q.allFinite() && reference.dq.allFinite() && std::isfinite(reference.phase) &&
         std::isfinite(reference.phase_rate_per_s) && std::isfinite(reference.gain) && finite(reference.command);
}

}  // namespace

TickOptions tick_options(const model::RobotModel& robot) {
  TickOptions options;
  options.generator = gco::generator_options(robot);
  options.arms = arms::read_arm_setup(robot);
  return options;
}

Tick::Tick(const model::RobotModel& robot, const ClipLibrary& library, std::unique_ptr<policy::Policy> policy,
           const io::Clock& stopwatch, const TickOptions& options)
    : stopwatch_(stopwatch),
      dt_s_(options.dt_s),
      policy_may_owe_ticks_(options.late_policy_ticks),
      spoiler_(options.spoiler),
      guard_(options.guard),
      gains_(gains_in_force(robot, *policy, guard_)),
      brake_kd_(own_gains(robot).kd_Nm_s_per_rad),
      motion_(robot, library, policy->variant(), options.generator, options.gco),
      policy_(std::move(policy)),
      supervisor_(robot, options.supervisor),
      entry_(options.entry),
      change_over_(options.change_over),
      hand_over_(options.change_over),
      limiter_(robot, gains_.kp_Nm_per_rad, gains_.kd_Nm_s_per_rad, options.dt_s, options.limiter),
      rehearsal_(options.rehearsal),
      action_monitor_(monitor_options(options.action_monitor, *policy_)),
      sit_down_(robot, library, options.sit_down, guard_),
      fallback_(options.sit_down.balanced.reference_s),
      target_(robot.q_stand()),
      rehearsed_(target_) {
  model::JointCommand& command = result_.command;
  command.q = robot.q_stand();
  for (JointVector* values : {&command.dq, &command.kp, &command.kd, &command.tau_ff}) {
    values->setZero(robot.joint_index.size());
  }
  result_.reference = motion_.reference();
  if (motion_.variant() == Variant::kPmg && options.velocity_trim.gain_per_s > 0.0)
    velocity_trim_.emplace(robot, options.velocity_trim, options.generator.double_support_rate, options.dt_s);
  if (policy_->needs_ground()) feet_.emplace(robot, options.foot_load, options.dt_s);
  if (options.arms) arms_.emplace(robot, *options.arms, options.dt_s);
  result_.arms.there = arms_.has_value();
  take_excitation(robot, options);
}

void Tick::take_excitation(const model::RobotModel& robot, const TickOptions& options) {
  if (!options.excitation && !options.robot_excitation) return;
  if (options.excitation && options.robot_excitation)
    throw std::invalid_argument("excitation: of one joint and of all; expected one of them");
  if (policy_->action_bound_rad()) throw std::invalid_argument("joints are excited without a policy; expected none");
  if (options.robot_excitation) {
    robot_excitation_.emplace(*options.robot_excitation, robot, options.dt_s, options.foot_load, guard_);
    return;
  }
  const Eigen::Index joint = options.excitation->joint;
  if (joint < 0 || joint >= target_.size()) throw std::invalid_argument("excitation: no such joint");
  excitation_.emplace(
      *options.excitation, robot,
      ExcitationPlayer::Told{target_[joint], gains_.kp_Nm_per_rad[joint], gains_.kd_Nm_s_per_rad[joint]}, options.dt_s,
      guard_);
}

const TickResult& Tick::step(const TickInput& input) noexcept {
  const io::Lap tick(stopwatch_);
  result_.times = StageTimes{};
  result_.limited = LimitReport{};
  result_.policy_held = false;
  reference_is_made_ = false;
  if (input.late_ns > 0) ++result_.late_ticks;
  take_messages(input);

  const Mode before = result_.mode;
  watch_feet(input.state);
  const Mode mode = supervisor_.update(supervisor_input(input));
  result_.user = supervisor_.admit(intake_.command());
  if (mode == Mode::kStand && before != Mode::kWalk && before != Mode::kStand) enter_stand(input.state);
  if (upright(mode)) {
    faults::Fault fault = drive(input.state);
    if (fault.code != faults::FaultCode::kNone) {
      fault.stamp_ns = input.now_ns;
      supervisor_.raise(fault);
    }
  }
  result_.mode = supervisor_.mode();
  if (result_.mode != Mode::kWalk) result_.arms.order = ArmsOrder::kNotWalking;
  result_.fault = supervisor_.fault();
  const bool sits_down = sit_down(input, before);
  if (!upright(result_.mode) && !sits_down) release(input.state, input.now_ns);
  result_.entering = result_.mode == Mode::kStand && !entry_.done();
  see_excitation();

  for (std::size_t i = 0; i < result_.ack_count; ++i) result_.acks[i].mode = result_.mode;
  result_.command.bus_sample = input.state.bus_sample;
  if (spoiler_ != nullptr) spoiler_->spoil(result_);
  result_.times.tick_ns = tick.elapsed_ns();
  return result_;
}

void Tick::see_excitation() noexcept {
  const bool ends = result_.mode != Mode::kStand;
  if (excitation_) {
    if (ends) excitation_->give_up();
    result_.excitation = excitation_->progress();
  } else if (robot_excitation_) {
    if (ends) robot_excitation_->give_up();
    result_.excitation = robot_excitation_->progress();
  }
}

void Tick::take_messages(const TickInput& input) noexcept {
  stop_asked_ = input.stop;
  if (input.stop) {
    supervisor_.stop();
    intake_.stop(input.now_ns);
  }
  for (const DriveMessage& drive : input.drives) intake_.accept(drive, input.now_ns);
  for (const ArmsMessage& message : input.arms) {
    if (arms_) {
      intake_.accept(message, input.now_ns);
    } else {
      intake_.ignore_arms();
    }
  }
  result_.arms.order = intake_.arms_order(input.now_ns);
  result_.arms.source = intake_.arms().source;
  result_.arms.sequence = intake_.arms().sequence;
  result_.arms.refused = intake_.arms_refused();
  result_.arms.refusal = intake_.arms_refusal();
  result_.ack_count = 0;
  const bool down = supervisor_.robot_is_down(input.state);
  for (const ModeRequest& request : input.requests.first(std::min(input.requests.size(), kMaxRequests))) {
    const CommandIntake::Judgement judgement = intake_.judge(request, input.now_ns, down);
    const bool refused = excites() && request.mode == Mode::kWalk && !request.reset_fault;
    if (judgement.fresh && !refused) supervisor_.request(request);
    // Before what else this tick was asked for; and a stop that isn't fresh asks for no more than this.
    if (request.stops() && judgement.verdict == Verdict::kTaken) {
      supervisor_.stop();
      stop_asked_ = true;
    }
    result_.acks[result_.ack_count++] = {.source = request.source,
                                         .sequence = request.sequence,
                                         .verdict = refused ? Verdict::kNoMode : judgement.verdict,
                                         .digest = request.digest};
  }
  result_.ignored = intake_.ignored();
  result_.command_age_s = intake_.age_s(input.now_ns);
  result_.driving = intake_.driving(input.now_ns);
}

faults::FaultEvidence Tick::evidence(const TickInput& input) const noexcept {
  return {.state = input.state,
          .bus = input.bus,
          .guard_trip = input.guard_trip,
          .late_ns = input.late_ns,
          .policy_late = input.policy_late,
          .now_ns = input.now_ns};
}

SupervisorInput Tick::supervisor_input(const TickInput& input) const noexcept {
  SupervisorInput known{.evidence = evidence(input),
                        .command_age_s = result_.command_age_s,
                        .entry_done = entry_.done() && result_.maker != TargetMaker::kReferenceRehearsed,
                        .at_rest = motion_.reference().gain == 0.0,
                        .gco_held_ticks = gco_held_ticks_,
                        .policy_waits = policy_waits(result_.maker)};
  // On its way from the posture in which it was found the torso may be anywhere.
  if (upright(result_.mode) && entry_.done()) {
    const Command& aim = result_.reference.command;
    known.evidence.torso = faults::RollPitchAim{.pitch_rad = aim[kPitch], .roll_rad = aim[kRoll]};
  }
  return known;
}

void Tick::watch_feet(const model::RobotState& state) noexcept {
  if (robot_excitation_ && upright(result_.mode)) robot_excitation_->watch(state, result_.command);
  if (!feet_ || !upright(result_.mode)) return;
  result_.foot_load.reset();
  // A robot that begins to hang is brought to rest first: legs that are thrown about look as if they carried.
  if (hanging(result_.maker) && (!change_over_.done() || result_.mode == Mode::kWalk)) return;
  feet_->update(state, result_.command, result_.reference.gain > 0.0);
  result_.foot_load = feet_->share();
  if (feet_->footing() == faults::Footing::kUnknown) return;
  const bool carry = feet_->footing() == faults::Footing::kStands;
  if (!take(carry ? TargetEvent::kFeetCarry : TargetEvent::kFeetCarryNothing)) return;
  if (!carry) return hang();
  refused_ticks_ = 0;
  if (rehearsal_.duration_s > 0.0) return;
  policy_->reset();  // as in a log from before policies were rehearsed
  take_over();
  change_over_.start(result_.command.q, motion_.reference().q);
}

bool Tick::take(TargetEvent event) noexcept {
  const TargetMaker before = std::exchange(result_.maker, next(result_.maker, event));
  return result_.maker != before;
}

void Tick::hang() noexcept {
  reset_motion();  // nobody steps in the air: the reference stands at once, and the supervisor leaves Walk
  gco_held_ticks_ = 0;
  begin_rehearsal();
  hand_over_.finish();
  change_over_.start(result_.command.q, motion_.reference().q);  // from the targets in force: no torque jumps
}

void Tick::take_over() noexcept {
  take(TargetEvent::kPolicyIsKnown);
  begin_policy();
}

void Tick::begin_policy() noexcept {
  action_monitor_.reset();
  policy_owes_ticks_ = 0;
}

void Tick::begin_rehearsal() noexcept {
  policy_->reset();
  rehearsed_ticks_ = refused_ticks_ = 0;
}

faults::Fault Tick::rehearse(const model::RobotState& state) noexcept {
  if (rehearsal_.duration_s <= 0.0) return {};
  const policy::Status status = act(state, rehearsed_);
  if (status == policy::Status::kLate) return {};
  if (!sound(status, rehearsed_)) return {.code = faults::FaultCode::kPolicyNotFinite};
  ++rehearsed_ticks_;
  const bool long_enough = rehearsed_ticks_ * dt_s_ >= rehearsal_.duration_s - 0.5 * dt_s_;
  if (!long_enough || result_.maker != TargetMaker::kReferenceRehearsed) {
    policy_->unsent();
    return {};
  }
  return judge_first_step();
}

faults::Fault Tick::judge_first_step() noexcept {
  Eigen::Index joint = 0;
  const double step_rad = (rehearsed_ - result_.reference.q).cwiseAbs().maxCoeff(&joint);
  if (step_rad <= rehearsal_.largest_step_rad) {
    take_over();
    hand_over_.start(result_.reference.q, rehearsed_);  // below the ramp into Stand, which goes on
    return {};
  }
  policy_->unsent();
  if (++refused_ticks_ < rehearsal_.refused_ticks) return {};
  return {.code = faults::FaultCode::kActionOutOfRange,
          .joint = static_cast<int>(joint),
          .value = step_rad,
          .limit = rehearsal_.largest_step_rad};
}

void Tick::reset_motion() noexcept {
  motion_.reset();
  if (velocity_trim_) velocity_trim_->reset();
}

void Tick::enter_stand(const model::RobotState& state) noexcept {
  reset_motion();
  take(feet_ ? TargetEvent::kStandBeginsOnTheGround : TargetEvent::kStandBegins);
  target_ = motion_.reference().q;
  fallback_.stop();
  if (arms_) arms_->reset(target_);
  gco_held_ticks_ = 0;
  entry_.start(state.q, target_);
  change_over_.finish();
  hand_over_.finish();
  limiter_.start_from(state.q);
  set_limiter_gains(gains_);
  if (robot_excitation_) robot_excitation_->start();
  begin_rehearsal();
  if (feet_) {
    feet_->start();
  } else {
    begin_policy();
  }
}

faults::Fault Tick::drive(const model::RobotState& state) noexcept {
  if (!reference_is_made_) {
    if (const faults::Fault fault = make_reference(state); fault.code != faults::FaultCode::kNone) return fault;
    lead_arms();
    reference_is_made_ = true;
  } else if (arms_) {
    result_.arms.arm = arms_->keep(result_.reference.q);
  }
  if (const faults::Fault fault = make_target(state); fault.code != faults::FaultCode::kNone) return fault;

  model::JointCommand& command = result_.command;
  command.q = target_;
  hand_over_.apply(dt_s_, command.q);
  entry_.apply(dt_s_, command.q);
  change_over_.apply(dt_s_, command.q);
  command.kp = gains_in_use().kp_Nm_per_rad;
  command.kd = gains_in_use().kd_Nm_s_per_rad;
  command.dq.setZero();
  command.tau_ff.setZero();
  if (excites() && entry_.done()) excite(command);
  result_.limited = limiter_.apply(state, command.dq, command.q);
  return {};
}

faults::Fault Tick::make_target(const model::RobotState& state) noexcept {
  if (runs_policy(result_.maker)) return ask_policy(state);
  target_ = result_.reference.q;
  if (!policy_waits(result_.maker)) return {};
  const faults::Fault fault = rehearse(state);
  if (runs_policy(result_.maker)) target_ = rehearsed_;
  return fault;
}

void Tick::excite(model::JointCommand& command) noexcept {
  if (excitation_) return excite_joint(command);
  robot_excitation_->step(command);
  for (Eigen::Index i = 0; i < command.q.size(); ++i) limiter_.set_gains(i, command.kp[i], command.kd[i]);
}

void Tick::excite_joint(model::JointCommand& command) noexcept {
  const ExcitationPlayer::Told& told = excitation_->step();
  const Eigen::Index joint = excitation_->joint();
  command.q[joint] = told.q_rad;
  command.kp[joint] = told.kp_Nm_per_rad;
  command.kd[joint] = told.kd_Nm_s_per_rad;
  limiter_.set_gains(joint, told.kp_Nm_per_rad, told.kd_Nm_s_per_rad);
}

faults::Fault Tick::make_reference(const model::RobotState& state) noexcept {
  const io::Lap generator(stopwatch_);
  const bool walks = supervisor_.mode() == Mode::kWalk && runs_policy(result_.maker);
  if (velocity_trim_) motion_.set_correction(velocity_trim_->step(state, result_.user, motion_.reference(), walks));
  result_.reference = motion_.advance(result_.user, dt_s_);
  if (spoiler_ != nullptr) spoiler_->spoil(result_.reference);
  result_.times.generator_ns = generator.elapsed_ns();
  if (fallback_.active() || !finite(result_.reference)) return without_generator();

  const io::Lap gco(stopwatch_);
  result_.optimised = motion_.ground();
  result_.times.gco_ns = gco.elapsed_ns();
  if (!finite(result_.optimised.command)) return without_generator();
  good_reference_ = result_.reference;
  good_observed_ = result_.optimised.command;
  gco_held_ticks_ = result_.optimised.status == gco::Status::kNotConverged ? gco_held_ticks_ + 1 : 0;
  return {};
}

void Tick::lead_arms() noexcept {
  if (!arms_) return;
  if (supervisor_.mode() != Mode::kWalk || policy_waits(result_.maker)) result_.arms.order = ArmsOrder::kNotWalking;
  const bool in_force = result_.arms.order == ArmsOrder::kInForce;
  result_.arms.arm = arms_->step(in_force ? &intake_.arms() : nullptr, result_.reference);
}

faults::Fault Tick::without_generator() noexcept {
  if (result_.mode != Mode::kFault) return {.code = faults::FaultCode::kReferenceNotFinite};
  if (!fallback_.active())
    fallback_.start(good_reference_, good_observed_, sit_down_.squat_rad(), sit_down_.lowest_m());
  result_.reference = fallback_.advance(dt_s_);
  result_.optimised.command = fallback_.observed();
  return {};
}

policy::Status Tick::act(const model::RobotState& state, JointVector& q_des) noexcept {
  const io::Lap lap(stopwatch_);
  const policy::Status status = policy_->act(state, result_.reference, result_.optimised.command, q_des);
  result_.times.policy_ns = lap.elapsed_ns();
  return status;
}

bool Tick::sound(policy::Status status, const JointVector& q_des) const noexcept {
  return status == policy::Status::kOk && q_des.size() == target_.size() && q_des.allFinite();
}

faults::Fault Tick::ask_policy(const model::RobotState& state) noexcept {
  JointVector& q_des = result_.command.q;
  const policy::Status status = act(state, q_des);
  result_.policy_held = status == policy::Status::kLate;
  if (result_.policy_held) {
    return ++policy_owes_ticks_ < policy_may_owe_ticks_ ? faults::Fault{}
                                                        : faults::Fault{.code = faults::FaultCode::kStalePolicy};
  }
  policy_owes_ticks_ = 0;
  if (!sound(status, q_des)) return {.code = faults::FaultCode::kPolicyNotFinite};
  target_ = q_des;
  return action_monitor_.watch(target_, result_.reference.q);
}

bool Tick::sit_down(const TickInput& input, Mode before) noexcept {
  if (result_.mode != Mode::kFault) {
    sit_down_.stop();
    return false;
  }
  const bool sound = !stop_asked_ && feet_ && supervisor_.robot_is_sound(evidence(input));
  if (sound && upright(before) && entry_.done() && result_.maker == TargetMaker::kPolicy &&
      faults::allows_sit_down(result_.fault.code)) {
    begin_sit_down(input);
  } else if (sound && sit_down_.active(input.now_ns) && result_.fault.code != faults::FaultCode::kJointTorque) {
    feet_->update(input.state, result_.command, false);  // by torques, which such a fault falsifies
  }
  if (sit_down_.active(input.now_ns) && (!sound || feet_->footing() == faults::Footing::kHangs)) sit_down_.stop();
  if (!sit_down_.active(input.now_ns)) return false;
  if (sit_down_.stage(input.now_ns) == SitDown::Stage::kReference) {
    if (lower_reference(input)) return true;
    sit_down_.lower_joints(input.state.q, limiter_.last(), gains_in_use().kp_Nm_per_rad, input.now_ns);
    set_limiter_gains(sit_down_.gains());
    take(TargetEvent::kReferenceIsDown);
  }
  sit_down_.step(input.now_ns, result_.command);
  if (arms_) result_.arms.arm = arms_->keep(result_.command.q);
  result_.limited = limiter_.apply(input.state, result_.command.dq, result_.command.q);
  return true;
}

void Tick::begin_sit_down(const TickInput& input) noexcept {
  motion_.set_rate(kHeight, sit_down_.options().height_rate_m_s);
  sit_down_.start(input.now_ns);
  const bool policy_is_sound = faults::policy_is_sound_after(result_.fault.code);
  take(policy_is_sound ? TargetEvent::kFaultWithAPolicy : TargetEvent::kFaultWithoutAPolicy);
  if (!policy_is_sound) leave_policy(input.state);
}

bool Tick::lower_reference(const TickInput& input) noexcept {
  // Without the policy a robot at rest is lowered at once: nothing but its stiffness balances it.
  const bool useful = runs_policy(result_.maker) || motion_.reference().gain > 0.0;
  if (!useful || !sit_down_.reference_is_due(input.now_ns)) return false;
  // A reference that failed is asked again in the next tick: a stop in mid-stride would fell the robot.
  const bool failed_now = input.now_ns == result_.fault.stamp_ns;
  if (failed_now && result_.fault.code == faults::FaultCode::kReferenceNotFinite) {
    result_.command.q = limiter_.last();
    return true;
  }
  if (!reference_is_made_) {
    result_.user = Command{};
    result_.user[kHeight] = sit_down_.lowest_m();
  }
  if (drive(input.state).code == faults::FaultCode::kNone) return true;
  if (!take(TargetEvent::kPolicyFails)) return false;
  leave_policy(input.state);  // it failed meanwhile; the reference goes on alone
  return lower_reference(input);
}

void Tick::leave_policy(const model::RobotState& state) noexcept {
  if (motion_.reference().gain > 0.0) sit_down_.lose_balance();
  hand_over_.finish();
  change_over_.start(sit_down_.same_torque(state.q, limiter_.last(), gains_.kp_Nm_per_rad), result_.reference.q);
  set_limiter_gains(sit_down_.gains());
}

void Tick::set_limiter_gains(const policy::DriveGains& gains) noexcept {
  for (Eigen::Index i = 0; i < target_.size(); ++i) {
    limiter_.set_gains(i, gains.kp_Nm_per_rad[i], gains.kd_Nm_s_per_rad[i]);
  }
}

void Tick::release(const model::RobotState& state, std::int64_t now_ns) noexcept {
  take(TargetEvent::kReleased);
  result_.foot_load.reset();
  const bool sat = sit_down_.stage(now_ns) == SitDown::Stage::kDamped;
  const JointVector& brake_kd = sat ? sit_down_.brake_kd() : brake_kd_;
  release_command(state, result_.mode == Mode::kPassive ? nullptr : &brake_kd, result_.command);
  if (arms_) result_.arms.arm = arms_->reset(result_.command.q);
}

}  // namespace pmg::control
