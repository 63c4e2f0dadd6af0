// The policy's interface. q_des = q_ref + action_scale * action for the policy joints (design: residual actions).
#pragma once

#include "model/robot_io.hpp"
#include "pmg/reference.hpp"

namespace pmg::policy {

enum class Status { kOk, kNotFinite };

class Policy {
 public:
  virtual ~Policy() = default;
  /// q_des for every joint, rad, from what a robot can sense. No exception.
  virtual Status act(const model::RobotState& state, const Reference& reference, const Command& optimised_command,
                     JointVector& q_des) noexcept = 0;
};

/// `--policy none`: q_des = q_ref.
class ReferencePolicy final : public Policy {
 public:
  Status act(const model::RobotState& state, const Reference& reference, const Command& optimised_command,
             JointVector& q_des) noexcept override;
};

}  // namespace pmg::policy
