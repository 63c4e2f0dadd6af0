#include "retargeting/fit_angles.hpp"

#include <ceres/ceres.h>

#include <algorithm>

namespace pmg::retargeting {

void fit_angles(ceres::CostFunction* cost, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double* angles) {
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, angles);
  for (int i = 0; i < lower.size(); ++i) {
    problem.SetParameterLowerBound(angles, i, lower[i]);
    problem.SetParameterUpperBound(angles, i, upper[i]);
    angles[i] = std::clamp(angles[i], lower[i], upper[i]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

}  // namespace pmg::retargeting
