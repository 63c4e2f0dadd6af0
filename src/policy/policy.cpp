#include "policy/policy.hpp"

namespace pmg::policy {

Status ReferencePolicy::act(const model::RobotState& /*state*/, const Reference& reference, const Command& /*observed*/,
                            JointVector& q_des) noexcept {
  q_des = reference.q;
  return Status::kOk;
}

}  // namespace pmg::policy
