// A policy of another project that follows velocities, run as its descriptor says. It needs no clips and no generator:
// the reference stands still, and the policy finds its gait itself.
#pragma once

#include <filesystem>
#include <memory>

#include "policy/policy.hpp"
#include "policy/policy_descriptor.hpp"

namespace pmg::policy {

class VelocityPolicy final : public Policy {
 public:
  /// Reads the descriptor and its network and replays the golden pairs, if it has any. Throws std::invalid_argument
  /// "FILE: what differs; expected what".
  VelocityPolicy(const std::filesystem::path& descriptor, const model::RobotModel& robot,
                 double control_rate_Hz = 100.0);
  ~VelocityPolicy() override;

  const PolicyDescriptor& descriptor() const;
  /// robot.yaml's standing posture with the policy's joints at its own default [rad].
  const JointVector& stand_rad() const;
  Variant variant() const override { return Variant::kVelocity; }
  std::optional<DriveGains> gains() const override;
  std::optional<double> action_bound_rad() const override;
  void reset() noexcept override;
  void unsent() noexcept override;  ///< the last action that the network sees is none

  /// Between two inferences the last targets are held.
  Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
             JointVector& q_des) noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::policy
