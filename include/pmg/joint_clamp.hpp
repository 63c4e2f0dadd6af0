// The last guard of the joint limits.
#pragma once

#include "pmg/types.hpp"

namespace pmg {

/// q = clamp(q, q_lower, q_upper) [rad], and dq = 0 where that changes q. True if any joint was clamped.
inline bool clamp_joints(const JointVector& q_lower, const JointVector& q_upper, JointVector& q,
                         JointVector& dq) noexcept {
  if ((q - q_upper).cwiseMax(q_lower - q).maxCoeff() <= 0.0) return false;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] >= q_lower[i] && q[i] <= q_upper[i]) continue;
    q[i] = q[i] > q_upper[i] ? q_upper[i] : q_lower[i];
    dq[i] = 0.0;
  }
  return true;
}

}  // namespace pmg
