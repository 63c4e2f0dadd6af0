#include "runtime/tick.hpp"

#include <algorithm>
#include <utility>

namespace pmg::runtime {

TickOptions tick_options(const model::RobotModel& robot) {
  TickOptions options;
  options.generator.limits = robot.command_limits;
  options.generator.scale_positive = robot.velocity_scale_positive;
  options.generator.scale_negative = robot.velocity_scale_negative;
  return options;
}

Tick::Tick(const model::RobotModel& robot, ClipLibrary library, std::unique_ptr<policy::Policy> policy,
           const io::Clock& stopwatch, const TickOptions& options)
    : stopwatch_(stopwatch),
      dt_s_(options.dt_s),
      generator_(std::move(library), options.generator),
      gco_(robot, options.gco),
      policy_(std::move(policy)),
      supervisor_(robot, options.supervisor),
      entry_(options.entry),
      limiter_(robot, options.dt_s, options.limiter) {
  const Eigen::Index n = robot.joint_index.size();
  kp_.resize(n);
  kd_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    kp_[i] = robot.joints[static_cast<std::size_t>(i)].kp_Nm_per_rad;
    kd_[i] = robot.joints[static_cast<std::size_t>(i)].kd_Nm_s_per_rad;
  }
  model::JointCommand& command = result_.command;
  command.q = robot.q_stand();
  for (JointVector* values : {&command.dq, &command.kp, &command.kd, &command.tau_ff}) values->setZero(n);
  generator_.reset();
  result_.reference = generator_.reference();
}

const TickResult& Tick::step(const TickInput& input) noexcept {
  const std::int64_t start_ns = stopwatch_.now_ns();
  result_.times = StageTimes{};
  result_.limited = LimitReport{};
  take_messages(input);

  const Mode before = result_.mode;
  const Mode mode = supervisor_.update({.state = input.state,
                                        .bus = input.bus,
                                        .guard_trip = input.guard_trip,
                                        .late_ns = input.late_ns,
                                        .now_ns = input.now_ns,
                                        .command_age_s = result_.command_age_s,
                                        .entry_done = entry_.done(),
                                        .at_rest = generator_.reference().gain == 0.0});
  result_.user = supervisor_.admit(intake_.command());
  if (mode == Mode::kStand && before != Mode::kWalk && before != Mode::kStand) enter_stand(input.state);

  const bool holding = mode == Mode::kStand || mode == Mode::kWalk;
  if (!holding || !drive(input)) release(input.state, supervisor_.mode() != Mode::kPassive);

  result_.mode = supervisor_.mode();
  result_.fault = supervisor_.fault();
  for (std::size_t i = 0; i < result_.ack_count; ++i) result_.acks[i].mode = result_.mode;
  result_.command.bus_sample = input.state.bus_sample;
  result_.times.tick_ns = stopwatch_.now_ns() - start_ns;
  return result_;
}

void Tick::take_messages(const TickInput& input) noexcept {
  for (const DriveMessage& drive : input.drives) intake_.accept(drive, input.now_ns);
  result_.ack_count = 0;
  for (const ModeRequest& request : input.requests.first(std::min(input.requests.size(), kMaxRequests))) {
    const Verdict verdict = intake_.judge(request, input.now_ns);
    if (verdict == Verdict::kTaken) supervisor_.request(request);
    result_.acks[result_.ack_count++] = {.source = request.source, .sequence = request.sequence, .verdict = verdict};
  }
  if (input.stop) supervisor_.stop();
  result_.ignored = intake_.ignored();
  result_.command_age_s = intake_.age_s(input.now_ns);
  result_.driving = intake_.driving(input.now_ns);
}

void Tick::enter_stand(const model::RobotState& state) noexcept {
  generator_.reset();
  gco_.reset();
  entry_.start(state.q, generator_.reference().q);
  limiter_.start_from(state.q);
}

bool Tick::drive(const TickInput& input) noexcept {
  StageTimes& times = result_.times;
  std::int64_t lap_ns = stopwatch_.now_ns();
  const auto lap = [&](std::int64_t& stage_ns) {
    const std::int64_t now_ns = stopwatch_.now_ns();
    stage_ns = now_ns - lap_ns;
    lap_ns = now_ns;
  };

  result_.reference = generator_.step(result_.user, dt_s_);
  lap(times.generator_ns);
  result_.optimised = gco_.solve(result_.reference);
  lap(times.gco_ns);

  model::JointCommand& command = result_.command;
  const policy::Status status = policy_->act(input.state, result_.reference, result_.optimised.command, command.q);
  lap(times.policy_ns);
  if (status != policy::Status::kOk || command.q.size() != kp_.size() || !command.q.allFinite()) {
    supervisor_.raise({.code = FaultCode::kPolicyNotFinite, .stamp_ns = input.now_ns});
    return false;
  }

  entry_.apply(dt_s_, command.q);
  result_.limited = limiter_.apply(input.state, command.q);
  command.dq.setZero();
  command.kp = kp_;
  command.kd = kd_;
  command.tau_ff.setZero();
  return true;
}

void Tick::release(const model::RobotState& state, bool brake) noexcept {
  model::JointCommand& command = result_.command;
  // The drives multiply it by zero; but zero times NaN is NaN, so a broken measurement must not pass through.
  const bool usable = state.q.size() == kp_.size() && state.q.allFinite();
  if (usable) {
    command.q = state.q;
  } else {
    command.q.setZero(kp_.size());
  }
  command.dq.setZero();
  command.kp.setZero();
  if (brake) {
    command.kd = kd_;
  } else {
    command.kd.setZero();
  }
  command.tau_ff.setZero();
}

}  // namespace pmg::runtime
