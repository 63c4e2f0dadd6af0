#pragma once

#include <Eigen/Core>

namespace ceres {
class CostFunction;
}

namespace pmg::retargeting {

/// Least squares for a limb's angles within [lower, upper] [rad]: begins at `angles`, clamped, and leaves the result
/// there. Takes the cost, of one parameter block.
void fit_angles(ceres::CostFunction* cost, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double* angles);

}  // namespace pmg::retargeting
