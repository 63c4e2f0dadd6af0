// Makes the legs' part of a dynamic clip by nonlinear least squares: the feet shall stay consistent with the ground at
// every gain at which the generator blends the clip with standing.
#pragma once

#include "generator/gait_task.hpp"
#include "generator/leg_geometry.hpp"
#include "pmg/types.hpp"
#include "work/progress.hpp"

namespace pmg::generator {

struct RobotLegs {
  PerFoot<LegGeometry> geometry;
  LegPose stand, lower, upper;     ///< [rad]
  LegVector<double> mirror_sign;   ///< q_right = mirror_sign * q_left of the mirrored posture
  double standing_height_m = 0.0;  ///< base above the soles
};

/// Throws files::ConfigError if the legs aren't mirror images.
RobotLegs robot_legs(const model::RobotModel& robot, const JointRoles& roles);

struct GaitSolution {
  LegTrajectory legs;
  double cost = 0.0;
  int iterations = 0;
};

/// (legs, task) => (leg trajectory). The generator blends in joint space: q = q_stand + g (q_clip - q_stand) +
/// addition. Unknowns are the knots of a periodic cubic spline of each leg joint's deviation from stand;
/// gait_residuals.hpp has the residuals. Deterministic. Reports progress after every iteration, many times a second;
/// throws work::Interrupted where progress is over.
GaitSolution optimize_gait(const RobotLegs& legs, const GaitTask& task, const work::Progress& progress = {});

}  // namespace pmg::generator
