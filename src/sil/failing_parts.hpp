// A bus and a policy that fail as a list of failures says.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "control/tick.hpp"
#include "hal/hal.hpp"
#include "policy/policy.hpp"
#include "sil/failures.hpp"

namespace pmg::sil {

/// What the two parts of a run share: the bus thread writes it.
struct FailureClock {
  std::atomic<double> now_s{0.0};      ///< time of the run, by its bus cycles
  std::atomic<bool> all_sleep{false};  ///< a stall of both threads lasts
  /// The first bus sample whose command lowers the robot: the control thread writes it; 0 before.
  std::atomic<std::uint64_t> sits_from_sample{0};
};

/// Passes another bus on and spoils what passes. In the bus thread; no heap after construction.
class FailingBus final : public hal::Hal {
 public:
  /// Keeps references to bus and clock. sleeps: a stall stops the calling thread (threads by the wall clock); false
  /// where the caller leaves the stalled cycles out itself and calls idle() instead (lockstep).
  FailingBus(hal::Hal& bus, std::vector<Failure> failures, const model::RobotModel& robot, FailureClock& clock,
             bool sleeps);

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;

  /// A cycle in which the bus thread sleeps: the drives hold their last command for watchdog_s, then brake by
  /// themselves.
  void idle() noexcept;
  bool bus_sleeps() const noexcept { return acts(FailureKind::kStall) || acts(FailureKind::kStallBus); }
  double overrun_s() const noexcept;  ///< of the tick that ends now
  bool control_sleeps() const noexcept { return acts(FailureKind::kStall) || acts(FailureKind::kStallControl); }

  const std::vector<Failure>& failures() const noexcept { return failures_; }
  /// By failure, after the run.
  const std::vector<FailureReaction>& reactions() const noexcept { return reactions_; }

  static constexpr double kWatchdog_s = 0.1;  ///< the drives' own: docs/how-to/operation.md

 private:
  static constexpr std::size_t kDelays = 501;  // a second of samples

  bool acts(FailureKind kind) const noexcept;
  void watch(const model::JointCommand& command) noexcept;
  void silence_motors(model::JointCommand& command) const noexcept;
  void spoil(const Failure& failure, std::size_t index, model::RobotState& state) noexcept;
  void sleep_through() noexcept;

  hal::Hal& bus_;
  std::vector<Failure> failures_;
  std::vector<FailureReaction> reactions_;
  FailureClock& clock_;
  const bool sleeps_;
  std::int64_t cycles_ = 0;
  double slept_s_ = 0.0;
  std::mt19937_64 random_{1};
  model::JointCommand held_, brake_;
  model::RobotState answer_;               // of the drives, before what is lost or late
  std::vector<model::RobotState> before_;  // by failure: the state in which it began
  std::vector<model::RobotState> late_;    // ring of the last second
};

/// Passes another policy on; in the control thread. sleeps: as FailingBus's.
class FailingPolicy final : public policy::Policy {
 public:
  FailingPolicy(std::unique_ptr<policy::Policy> own, std::vector<Failure> failures, const FailureClock& clock,
                bool sleeps)
      : own_(std::move(own)), failures_(std::move(failures)), clock_(clock), sleeps_(sleeps) {}
  Variant variant() const override { return own_->variant(); }
  std::optional<policy::DriveGains> gains() const override { return own_->gains(); }
  std::optional<double> action_bound_rad() const override { return own_->action_bound_rad(); }
  bool needs_ground() const override { return own_->needs_ground(); }
  void reset() noexcept override { own_->reset(); }
  void unsent() noexcept override { own_->unsent(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override;

 private:
  std::unique_ptr<policy::Policy> own_;
  std::vector<Failure> failures_;
  const FailureClock& clock_;
  const bool sleeps_;
};

/// Spoils the tick; in the control thread. sleeps: as FailingBus's.
class FailingTick final : public control::TickSpoiler {
 public:
  FailingTick(std::vector<Failure> failures, FailureClock& clock, bool sleeps)
      : failures_(std::move(failures)), clock_(clock), sleeps_(sleeps) {}
  void spoil(Reference& reference) noexcept override;
  void spoil(control::TickResult& result) noexcept override;

 private:
  const Failure* acting(FailureKind kind) const noexcept;

  std::vector<Failure> failures_;
  FailureClock& clock_;
  const bool sleeps_;
};

}  // namespace pmg::sil
