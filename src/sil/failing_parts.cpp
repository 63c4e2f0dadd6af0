#include "sil/failing_parts.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "hal/bus_cycle.hpp"

namespace pmg::sil {

namespace {

constexpr double kCycle_s = static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool braking(const model::JointCommand& command) noexcept {
  return command.kp.size() > 0 && command.kp.cwiseAbs().maxCoeff() == 0.0 && command.kd.maxCoeff() > 0.0;
}

}  // namespace

FailingBus::FailingBus(hal::Hal& bus, std::vector<Failure> failures, const model::RobotModel& robot,
                       FailureClock& clock, bool sleeps)
    : bus_(bus),
      failures_(std::move(failures)),
      reactions_(failures_.size()),
      clock_(clock),
      sleeps_(sleeps),
      before_(failures_.size()) {
  const Eigen::Index n = robot.joint_index.size();
  brake_.q = robot.q_stand();
  for (JointVector* values : {&brake_.dq, &brake_.kp, &brake_.tau_ff}) values->setZero(n);
  brake_.kd.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) brake_.kd[i] = robot.joints[static_cast<std::size_t>(i)].kd_Nm_s_per_rad;
  held_ = brake_;
  held_.kd.setZero();
  if (std::ranges::any_of(failures_, [](const Failure& f) { return f.kind == FailureKind::kDelay; })) {
    late_.resize(kDelays);
  }
}

bool FailingBus::acts(FailureKind kind) const noexcept {
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  return std::ranges::any_of(failures_, [&](const Failure& f) { return f.kind == kind && f.acts(now_s); });
}

hal::BusStatus FailingBus::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  watch(command);
  if (sleeps_ && bus_sleeps()) sleep_through();
  held_ = command;
  silence_motors(held_);
  hal::BusStatus status = bus_.exchange(held_, answer_);
  held_ = command;
  slept_s_ = 0.0;
  const double now_s = static_cast<double>(++cycles_) * kCycle_s;
  clock_.now_s.store(now_s, std::memory_order_relaxed);
  if (!late_.empty()) late_[static_cast<std::size_t>(cycles_) % kDelays] = answer_;
  if (status != hal::BusStatus::kOk) return status;
  model::RobotState& told = answer_;
  for (std::size_t i = 0; i < failures_.size(); ++i) {
    const Failure& failure = failures_[i];
    if (failure.acts(now_s)) {
      if (failure.kind == FailureKind::kPacketLoss && static_cast<double>(random_() % 10'000) < 100.0 * failure.value) {
        status = hal::BusStatus::kStale;
      }
      if (failure.kind == FailureKind::kBusLost) status = hal::BusStatus::kLost;
      spoil(failure, i, told);
    } else if (now_s < failure.at_s) {
      before_[i] = told;
    }
  }
  if (status == hal::BusStatus::kOk) {
    const std::int64_t stamp_ns = state.stamp_ns;
    state = told;
    state.stamp_ns = stamp_ns;
  }
  return status;
}

double FailingBus::overrun_s() const noexcept {
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  double longest_s = 0.0;
  for (const Failure& failure : failures_) {
    if (failure.kind == FailureKind::kOverrun && failure.acts(now_s)) longest_s = std::max(longest_s, failure.value);
  }
  return longest_s;
}

void FailingBus::idle() noexcept {
  slept_s_ += kCycle_s;
  bus_.exchange(slept_s_ > kWatchdog_s ? brake_ : held_, answer_);
  clock_.now_s.store(static_cast<double>(++cycles_) * kCycle_s, std::memory_order_relaxed);
}

/// The command of the cycle that comes, counted from the first one that carries the failure.
void FailingBus::watch(const model::JointCommand& command) noexcept {
  const double now_s = static_cast<double>(cycles_ + 1) * kCycle_s;
  const std::uint64_t sits_from = clock_.sits_from_sample.load();
  for (std::size_t i = 0; i < failures_.size(); ++i) {
    const Failure& failure = failures_[i];
    FailureReaction& reaction = reactions_[i];
    if (now_s < failure.at_s - 0.5 * kCycle_s) continue;
    const auto cycle = static_cast<std::int64_t>(std::llround((now_s - failure.at_s) / kCycle_s));
    if (reaction.cycles_to_damping >= 0) continue;
    if (braking(command)) {
      reaction.cycles_to_damping = cycle;
    } else if (reaction.cycles_to_sit_down < 0 && sits_from != 0 && command.bus_sample >= sits_from) {
      reaction.cycles_to_sit_down = cycle;
    }
  }
}

void FailingBus::silence_motors(model::JointCommand& command) const noexcept {
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  for (const Failure& failure : failures_) {
    if (failure.kind != FailureKind::kMotorSilent || !failure.acts(now_s)) continue;
    for (JointVector* values : {&command.kp, &command.kd, &command.tau_ff}) (*values)[failure.joint] = 0.0;
  }
}

void FailingBus::spoil(const Failure& failure, std::size_t index, model::RobotState& state) noexcept {
  const model::RobotState& before = before_[index];
  switch (failure.kind) {
    case FailureKind::kEncoderStuck:
      if (before.q.size() == state.q.size()) state.q[failure.joint] = before.q[failure.joint];
      break;
    case FailureKind::kEncoderOffset:
      state.q[failure.joint] += failure.value;
      break;
    case FailureKind::kEncoderLost:
      state.q[failure.joint] = kNan;
      break;
    case FailureKind::kSpeedReading:
      state.dq[failure.joint] = failure.value;
      break;
    case FailureKind::kTorqueReading:
      state.tau[failure.joint] = failure.value;
      break;
    case FailureKind::kHot:
      state.temperature_degC[failure.joint] = failure.value;
      break;
    case FailureKind::kImuLost:
      state.gyro_rad_s.setConstant(kNan);
      state.acceleration_m_s2.setConstant(kNan);
      state.orientation_WI.coeffs().setConstant(kNan);
      break;
    case FailureKind::kImuFrozen:
      state.gyro_rad_s = before.gyro_rad_s;
      state.acceleration_m_s2 = before.acceleration_m_s2;
      state.orientation_WI = before.orientation_WI;
      break;
    case FailureKind::kImuDrift: {
      const double since_s = static_cast<double>(cycles_) * kCycle_s - failure.at_s;
      state.orientation_WI =
          Eigen::AngleAxisd(failure.value * since_s, Eigen::Vector3d::UnitY()) * state.orientation_WI;
      break;
    }
    case FailureKind::kDelay: {
      const auto cycles = std::min(static_cast<std::int64_t>(std::llround(failure.value / kCycle_s)), cycles_ - 1);
      const std::uint64_t sample = state.bus_sample;
      state = late_[static_cast<std::size_t>(cycles_ - cycles) % kDelays];
      state.bus_sample = sample;
      break;
    }
    default:  // of the bus as a whole, a thread, a motor or the policy
      break;
  }
}

/// By the wall clock: until the failure is over. The simulation stands still meanwhile, as it is this thread's.
void FailingBus::sleep_through() noexcept {
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  double until_s = now_s;
  clock_.all_sleep.store(acts(FailureKind::kStall));
  for (Failure& failure : failures_) {
    const bool stall = failure.kind == FailureKind::kStall || failure.kind == FailureKind::kStallBus;
    if (!stall || !failure.acts(now_s)) continue;
    until_s = std::max(until_s, failure.at_s + failure.for_s);
    failure.for_s = 0.0;  // the run's time stands still meanwhile: it is over then
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(until_s - now_s));
  clock_.all_sleep.store(false);
}

policy::Status FailingPolicy::act(const model::RobotState& state, const Reference& reference, const Command& observed,
                                  JointVector& q_des) noexcept {
  const auto sleeps = [this] {
    const double now_s = clock_.now_s.load(std::memory_order_relaxed);
    return clock_.all_sleep.load() || std::ranges::any_of(failures_, [&](const Failure& failure) {
             return failure.kind == FailureKind::kStallControl && failure.acts(now_s);
           });
  };
  while (sleeps_ && sleeps()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  policy::Status status = own_->act(state, reference, observed, q_des);
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  for (const Failure& failure : failures_) {
    if (!failure.acts(now_s)) continue;
    if (failure.kind == FailureKind::kPolicyLate) status = policy::Status::kLate;
    if (failure.kind == FailureKind::kPolicyNotFinite) q_des.setConstant(kNan);
    if (failure.kind == FailureKind::kPolicyFar) q_des[failure.joint] = reference.q[failure.joint] + failure.value;
  }
  return status;
}

const Failure* FailingTick::acting(FailureKind kind) const noexcept {
  const double now_s = clock_.now_s.load(std::memory_order_relaxed);
  const auto found = std::ranges::find_if(failures_, [&](const Failure& f) { return f.kind == kind && f.acts(now_s); });
  return found == failures_.end() ? nullptr : &*found;
}

void FailingTick::spoil(Reference& reference) noexcept {
  if (acting(FailureKind::kReferenceNotFinite) != nullptr) reference.q.setConstant(kNan);
}

void FailingTick::spoil(control::TickResult& result) noexcept {
  if (acting(FailureKind::kCommandNotFinite) != nullptr) result.command.q.setConstant(kNan);
  if (!control::sitting_down(result.maker)) {
    clock_.sits_from_sample.store(0);
  } else if (clock_.sits_from_sample.load() == 0) {
    clock_.sits_from_sample.store(result.command.bus_sample);
  }
  const Failure* overrun = acting(FailureKind::kOverrun);
  if (sleeps_ && overrun != nullptr) std::this_thread::sleep_for(std::chrono::duration<double>(overrun->value));
}

}  // namespace pmg::sil
