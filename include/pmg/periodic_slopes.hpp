// The slopes of a clip's samples: with them a clip read from any source is complete.
#pragma once

#include <Eigen/LU>
#include <cstddef>
#include <vector>

#include "pmg/types.hpp"

namespace pmg {

/// dq/dphi [rad per cycle] at N equidistant samples of a cycle (at least one): the slopes of the periodic cubic spline
/// through them. With the slopes m_k:  m_(k-1) + 4 m_k + m_(k+1) = 3 N (q_(k+1) - q_(k-1)). Allocates.
inline std::vector<JointVector> periodic_spline_slopes(const std::vector<JointVector>& q) {
  const auto n = static_cast<Eigen::Index>(q.size());
  const Eigen::Index joints = q.front().size();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n, n), right(n, joints);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index before = (k + n - 1) % n, after = (k + 1) % n;
    system(k, k) += 4.0;
    system(k, before) += 1.0;
    system(k, after) += 1.0;
    right.row(k) = 3.0 * static_cast<double>(n) *
                   (q[static_cast<std::size_t>(after)] - q[static_cast<std::size_t>(before)]).transpose();
  }
  const Eigen::MatrixXd slopes = system.partialPivLu().solve(right);
  std::vector<JointVector> result;
  for (Eigen::Index k = 0; k < n; ++k) result.emplace_back(slopes.row(k).transpose());
  return result;
}

}  // namespace pmg
