// The policy's interface: q_des = q_ref + action_scale * action for the policy joints (residual actions).
#pragma once

#include <optional>

#include "model/robot_io.hpp"
#include "pmg/reference.hpp"
#include "pmg/variant.hpp"

namespace pmg::policy {

enum class Status {
  kOk,
  kNotFinite,  ///< a value that isn't finite, or no result at all; this is a fault
  kLate,       ///< no result for this tick: the last target is held, for a few ticks
};

/// Gains of the drives' position loops, one value per joint in the robot's joint order.
struct DriveGains {
  JointVector kp_Nm_per_rad, kd_Nm_s_per_rad;
};

class Policy {
 public:
  virtual ~Policy() = default;

  /// The variant that the policy was trained as; it decides how a tick is composed. Asked once, before the first act().
  virtual Variant variant() const { return Variant::kPmg; }

  /// The gains of the policy's training; nullopt: robot.yaml's. Asked once, before the first act().
  virtual std::optional<DriveGains> gains() const { return std::nullopt; }

  /// Largest |q_des - q_ref| of the policy in normal operation [rad]; nullopt: the monitor's own bound.
  virtual std::optional<double> action_bound_rad() const { return std::nullopt; }

  /// True if the policy runs only while the feet carry the robot, as any balancing policy must. Asked once, before the
  /// first act().
  virtual bool needs_ground() const { return true; }

  /// Forgets the history. Called before the first act() after an entry into Stand, and after the robot has hung.
  virtual void reset() noexcept {}

  /// (state, reference, observed command) => (q_des of every joint [rad]). observed: u' for PMG, u for the baselines.
  /// No exception. q_des is valid only with kOk.
  virtual Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept = 0;

  /// After act(): its targets were not sent, and the drives follow the reference alone. The next act() sees it so.
  virtual void unsent() noexcept {}
};

/// `--policy none`: q_des = q_ref, also in the air, as a first start needs.
class ReferencePolicy final : public Policy {
 public:
  bool needs_ground() const override { return false; }
  Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
             JointVector& q_des) noexcept override;
};

}  // namespace pmg::policy
