// Measures of a leg trajectory on the ground: the figures by which clips are accepted.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "generator/gait_optimization.hpp"
#include "generator/gait_task.hpp"
#include "pmg/blending.hpp"

namespace pmg::generator {

/// Timing of a clip: left initial contact at phase 0, right half a cycle later.
GaitTiming timing(double period_s, double duty_factor);

/// q = q_stand + gain (q_clip - q_stand) + addition, at every sample.
LegTrajectory blend(const RobotLegs& legs, const LegTrajectory& clip, const Scenario& scenario);

/// Attitude of the base in the heading frame and its rate [rad/s, in that frame].
struct BaseMotion {
  Eigen::Matrix3d R_HB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d omega_HB = Eigen::Vector3d::Zero();
};

/// The base of a task's clip at this gain, one entry per sample.
std::vector<BaseMotion> hiking_base(const GaitTask& task, double gain);

/// The base in a scenario, including the addition's roll.
std::vector<BaseMotion> hiking_base(const GaitTask& task, const Scenario& scenario);

struct GroundMeasure {
  /// Velocity of the base from the stance feet: vx, vy [m/s], omega [rad/s].
  Eigen::Vector3d mean_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_range = Eigen::Vector3d::Zero();  ///< largest deviation from the mean
  double slip_mean_m_s = 0.0, slip_p95_m_s = 0.0;  ///< each foot in double support, under the best base motion
  double yaw_slip_max_rad_s = 0.0;                 ///< the same for the yaw rate of a foot
  double other_foot_height_m = 0.0;                ///< largest height of the higher stance foot in double support
  double clearance_m = 0.0;     ///< lowest sole point in mid swing (0.3 to 0.7 of the swing), of the lower foot
  double landing_m = 0.0;       ///< lowest sole point late in the swing (0.7 to 0.85 of it), of the lower foot
  double lowest_swing_m = 0.0;  ///< lowest sole point anywhere in the swing; negative: below the ground
  double foot_gap_m = 0.0;      ///< smallest gap between the soles along the base's y axis
  double height_mean_m = 0.0, height_min_m = 0.0, height_max_m = 0.0;  ///< base, deviation from stand
};

/// (trajectory, timing, base) => (measures). base: one entry per sample, or empty for a level base. Contact edges are
/// 0.04 of a cycle wide, as the generator's, but centred on the stance's boundaries. In swing the ground is where the
/// ground-aware optimisation sees it: while a foot's contact weight fades, the foot still holds its share of the
/// height.
GroundMeasure measure(const RobotLegs& legs, const LegTrajectory& trajectory, const GaitTiming& timing,
                      const std::vector<BaseMotion>& base = {});

}  // namespace pmg::generator
