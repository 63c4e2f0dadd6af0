// Joint curves from which a clip's optimisation starts and near which it stays: published ones for walking, flat
// stepping otherwise.
#pragma once

#include <vector>

#include "generator/gait_optimization.hpp"
#include "generator/gait_task.hpp"

namespace pmg::generator {

/// Hip (without the pelvis' tilt), knee and ankle as published for adults; the other joints in the standing posture.
std::vector<LegPose> published_reference(const RobotLegs& legs);

/// Walking backward is nearly walking forward with time reversed (A. Thorstensson, Acta Physiol. Scand. 128, 1986; D.
/// Winter, N. Pluck, J. Yang, J. Mot. Behav. 21, 1989). The result is the forward clip reversed, scaled about the
/// standing posture, and shifted so that its left initial contact is at phase 0.
std::vector<LegPose> reversed_reference(const RobotLegs& legs, const LegTrajectory& forward, double forward_duty_factor,
                                        double scale);

/// Feet flat on the ground under a base that moves steadily; they are lifted in swing.
struct Stepping {
  double half_width_m = 0.1;  ///< mean sideways distance of a foot from the base
  double toe_out_rad = 0.0;
  double lift_m = 0.05;
  double height_m = 0.0;  ///< base, deviation from stand
};
std::vector<LegPose> stepping_reference(const RobotLegs& legs, const GaitTask& task, const Stepping& stepping);

/// Joint angles that put a foot into this pose, by damped Gauss-Newton from the start:
///   (J^T J + 1e-8 I) dq = J^T e, |dq_i| at most 0.2 rad.
/// Throws std::runtime_error if the error stays above 0.1 mm or 1e-4 rad.
LegVector<double> reach(const LegGeometry& leg, const Eigen::Matrix3d& R_BF, const Eigen::Vector3d& p_BF,
                        const LegVector<double>& start);

}  // namespace pmg::generator
