// Shared by the tests of control and runtime: robots, a bus without physics, a policy that can be made to fail.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <kdl/chaindynparam.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "control/tick.hpp"
#include "hal/hal.hpp"
#include "io/clock.hpp"
#include "model/clip_library_file.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"
#include "model/robots.hpp"

namespace pmg::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kTick_s = 0.01;
inline constexpr int kCyclesPerTick = 5;  // of the bus

inline ClipLibrary clips(const model::RobotModel& robot) {
  return model::load_clip_library(robot.directory / "clips", robot);
}

/// Leg torques of a robot at rest with an upright pelvis, carried by its feet. No heap after construction.
class LoadedFeet {
 public:
  explicit LoadedFeet(const model::RobotModel& robot)
      : robot_(robot),
        legs_(robot),
        gravity_{KDL::ChainDynParam(robot.leg_chain[kLeft], KDL::Vector(0.0, 0.0, -9.81)),
                 KDL::ChainDynParam(robot.leg_chain[kRight], KDL::Vector(0.0, 0.0, -9.81))} {
    for (const Foot foot : {kLeft, kRight}) q_[foot].resize(joints(foot)), holding_[foot].resize(joints(foot));
  }

  /// share: each foot's part of the weight. Does not change a state with broken q.
  void apply(const PerFoot<double>& share, model::RobotState& state) {
    const int n = robot_.joint_index.size();
    if (state.q.size() != n || state.tau.size() != n || state.dq.size() != n || !state.q.allFinite()) return;
    const auto& feet = legs_.compute(state.q, state.dq);
    for (const Foot foot : {kLeft, kRight}) {
      for (unsigned i = 0; i < joints(foot); ++i) q_[foot](i) = state.q[robot_.leg_joints[foot][i]];
      gravity_[foot].JntToGravity(q_[foot], holding_[foot]);
      for (unsigned i = 0; i < joints(foot); ++i) {
        state.tau[robot_.leg_joints[foot][i]] =
            holding_[foot](i) - feet[foot].J(2, i) * share[foot] * robot_.total_mass_kg * 9.81;
      }
    }
  }

 private:
  unsigned joints(Foot foot) const { return static_cast<unsigned>(robot_.leg_joints[foot].size()); }

  const model::RobotModel& robot_;
  model::LegKinematics legs_;
  PerFoot<KDL::ChainDynParam> gravity_;
  PerFoot<KDL::JntArray> q_, holding_;
};

/// Standing still on both feet, without any defect.
inline model::RobotState standing_state(const model::RobotModel& robot) {
  const int n = robot.joint_index.size();
  model::RobotState state;
  state.q = robot.q_stand();
  state.dq = state.tau = JointVector::Zero(n);
  state.temperature_degC = JointVector::Constant(n, 35.0);
  state.acceleration_m_s2 = {0.0, 0.0, 9.81};
  // The IMU's link is upright: R_WI = R_LI.
  state.orientation_WI = Eigen::Quaterniond(robot.imu.T_LI.linear());
  LoadedFeet(robot).apply({0.5, 0.5}, state);
  return state;
}

/// Drives that follow at once, in a world where nothing falls.
class IdealBus final : public hal::Hal {
 public:
  explicit IdealBus(const model::RobotModel& robot) : feet_(robot), state_(standing_state(robot)) {}

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    state_.bus_sample += 1;
    state_.stamp_ns = static_cast<std::int64_t>(state_.bus_sample) * 2'000'000;
    if (command.kp.sum() > 0.0) state_.q = command.q;
    feet_.apply({0.5, 0.5}, state_);
    state = state_;
    last_command = command;
    return status;
  }

  hal::BusStatus status = hal::BusStatus::kOk;
  model::JointCommand last_command;

 private:
  LoadedFeet feet_;
  model::RobotState state_;
};

/// Follows the reference until told to break.
class BreakablePolicy final : public policy::Policy {
 public:
  enum class Break { kNone, kStatus, kNotANumber, kHeap, kLate, kFarAction };
  explicit BreakablePolicy(bool needs_the_ground = true) : balances(needs_the_ground) {}
  policy::Status act(const model::RobotState&, const Reference& reference, const Command& optimised,
                     JointVector& q_des) noexcept override {
    ++calls;
    if (meanwhile) meanwhile();
    seen_command = optimised;
    q_des = reference.q;
    q_des[3] += pull_rad;
    if (how == Break::kNotANumber) q_des[0] = std::numeric_limits<double>::quiet_NaN();
    if (how == Break::kHeap) heap_ = std::make_unique<double>(reference.phase);
    if (how == Break::kFarAction) q_des[3] += faults::ActionMonitorOptions{}.bound_rad + 0.1;
    if (how == Break::kLate) q_des.setConstant(9.0);  // values left by a late policy must not count
    if (how == Break::kLate) return policy::Status::kLate;
    return how == Break::kStatus ? policy::Status::kNotFinite : policy::Status::kOk;
  }
  std::optional<policy::DriveGains> gains() const override { return own_gains; }
  void reset() noexcept override { ++resets; }
  void unsent() noexcept override {
    --calls;
    ++unsent_calls;
  }
  bool needs_ground() const override { return balances; }

  Break how = Break::kNone;
  bool balances;
  int calls = 0, unsent_calls = 0;  ///< by what became of their targets
  double pull_rad = 0.0;            ///< of the joint of index 3 from its reference
  std::function<void()> meanwhile;  ///< runs while the policy computes
  std::optional<policy::DriveGains> own_gains;
  Command seen_command;
  int resets = 0;

 private:
  std::unique_ptr<double> heap_;
};

/// A tick with its operator, who sends a fresh command and a request every time.
struct DrivenTick {
  explicit DrivenTick(const model::RobotModel& robot)
      : DrivenTick(robot, std::make_unique<BreakablePolicy>(), clips(robot)) {}
  DrivenTick(const model::RobotModel& robot, std::unique_ptr<BreakablePolicy> any_policy)
      : DrivenTick(robot, std::move(any_policy), clips(robot)) {}
  DrivenTick(const model::RobotModel& robot, std::unique_ptr<BreakablePolicy> any_policy, ClipLibrary library)
      : feet(robot),
        state(standing_state(robot)),
        policy(any_policy.get()),
        tick(robot, library, std::move(any_policy), clock, control::tick_options(robot)) {
    drive.source = request.source = arms.source = control::Source::make("test", 1);
    drive.lease_s = arms.lease_s = 0.5;
  }

  /// Runs the next tick, with drives that follow at once.
  const control::TickResult& step(bool speaking = true) {
    now_ns += 10'000'000;
    state.stamp_ns = now_ns;
    state.bus_sample += 5;
    ++drive.sequence;
    ++request.sequence;
    ++arms.sequence;
    drive.stamp_ns = drive.received_ns = request.stamp_ns = request.received_ns = now_ns;
    arms.stamp_ns = arms.received_ns = now_ns;
    const std::size_t messages = speaking ? 1 : 0;
    const control::TickResult& result = tick.step({.state = state,
                                                   .bus = bus,
                                                   .now_ns = now_ns,
                                                   .drives = {&drive, messages},
                                                   .requests = {&request, asking ? messages : 0},
                                                   .arms = {&arms, leading ? messages : 0}});
    if (result.command.kp.sum() > 0.0) state.q = result.command.q;
    feet.apply(carried, state);
    return result;
  }
  const control::TickResult& run(double duration_s, bool speaking = true) {
    for (long k = 0; k < std::lround(duration_s * 100.0); ++k) step(speaking);
    return tick.result();
  }

  io::SimulationClock clock;
  LoadedFeet feet;
  PerFoot<double> carried{0.5, 0.5};  ///< share of the weight, by foot
  model::RobotState state;
  BreakablePolicy* policy;
  control::Tick tick;
  hal::BusStatus bus = hal::BusStatus::kOk;
  bool asking = true;  ///< sends a request in every tick
  std::int64_t now_ns = 0;
  control::DriveMessage drive;
  control::ModeRequest request;
  bool leading = false;  ///< sends arms in every tick
  control::ArmsMessage arms;
};

}  // namespace pmg::test
