// The policy's interface. q_des = q_ref + action_scale * action for the policy joints (design: residual actions).
#pragma once

#include <optional>

#include "model/robot_io.hpp"
#include "pmg/reference.hpp"
#include "pmg/variant.hpp"

namespace pmg::policy {

enum class Status {
  kOk,
  kNotFinite,  ///< a value that isn't finite, or no result at all: a fault
  kLate,       ///< no result for this tick: the last target is held, for a few ticks
};

/// What the drives' position loops are set to, one value a joint in the robot's joint order.
struct DriveGains {
  JointVector kp_Nm_per_rad, kd_Nm_s_per_rad;
};

class Policy {
 public:
  virtual ~Policy() = default;

  /// What it imitates and observes: decides how a tick is composed. Asked once, before the first act().
  virtual Variant variant() const { return Variant::kPmg; }

  /// The gains that the policy was trained with; nothing: robot.yaml's. Asked once, before the first act().
  virtual std::optional<DriveGains> gains() const { return std::nullopt; }

  /// Largest |q_des - q_ref| that the policy gives while it is in its element [rad]; nothing: the monitor's own bound.
  virtual std::optional<double> action_bound_rad() const { return std::nullopt; }

  /// Whether it runs only while the feet carry the robot, as whatever balances must. Asked once, before the first
  /// act().
  virtual bool needs_ground() const { return true; }

  /// Forgets its history. Before the first act() after an entry into Stand, and after the robot has hung.
  virtual void reset() noexcept {}

  /// q_des for every joint, rad, from what a robot can sense. observed: u' for PMG, u for the baselines. No exception.
  /// q_des counts only with kOk.
  virtual Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept = 0;
};

/// `--policy none`: q_des = q_ref, in the air too, as a first start needs it.
class ReferencePolicy final : public Policy {
 public:
  bool needs_ground() const override { return false; }
  Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
             JointVector& q_des) noexcept override;
};

}  // namespace pmg::policy
