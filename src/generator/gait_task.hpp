// The specification of a dynamic clip: input of the optimisation in gait_optimization.hpp.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "generator/leg_geometry.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

inline constexpr std::size_t kClipSamples = 100;  ///< rows of a dynamic clip; phase k / kClipSamples

/// Both legs' joint angles at one phase.
using LegPose = PerFoot<LegVector<double>>;

/// Joint angles [rad] and slopes [rad per cycle] of both legs over one cycle.
struct LegTrajectory {
  std::vector<LegPose> q, dq_dphi;
};

/// Roll of the base, positive to the right, and its slope [rad per cycle].
struct Roll {
  double angle_rad = 0.0, slope_rad = 0.0;
};

/// Joint angles that the generator adds to this clip's, and the velocity that they cause: a posture offset (constant)
/// or another clip in a mixture. Empty trajectories mean none.
struct Addition {
  std::vector<LegPose> q, dq_dphi;                     ///< one entry (constant) or one per sample; deviation from stand
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< vx, vy [m/s], omega [rad/s]
  double sway_m = 0.0;                                 ///< added to the base's sway
  double height_m = 0.0;                               ///< added to the base height
  std::vector<Roll> roll;                              ///< added to the base's roll, one per sample
};

/// Required agreement of a joint's curve with the reference's.
struct ShapeGoal {
  LegRole role = kKnee;
  double correlation = 0.95;  ///< at least
  double rms_rad = 0.1;       ///< at most, including the difference of the means
  double amplitude = 0.0;     ///< at least; slope of the regression on the reference
};

/// The clip at one gain, with or without an addition: one set of ground residuals.
struct Scenario {
  double gain = 1.0;
  double weight = 1.0;
  Addition addition;
  double lift = 0.0;      ///< amplitude of the gait whose clearance is required; 0: the gain
  bool promised = false;  ///< the mean velocity is also met with the addition; without an addition it always is
};

struct GaitWeights {
  double slip = 20.0;          ///< per m/s, feet against each other in double support
  double slip_yaw = 5.0;       ///< per rad/s
  double step_height = 600.0;  ///< per m beyond step_height_free_m, height difference of the feet in double support
  double step_height_free_m = 0.006;  ///< free, because only the lower foot is held to the ground
  double step_height_inside = 30.0;   ///< per m of the whole difference
  double velocity = 3.0;              ///< per m/s, base against the required velocity
  double velocity_yaw = 3.0;          ///< per rad/s
  double velocity_up = 0.5;           ///< per m/s
  double height = 3.0;                ///< per m, base against the required height
  double clearance = 150.0;           ///< per m below the required clearance
  double above_ground = 400.0;        ///< per m of the swinging sole below the ground
  double foot_flat = 10.0;            ///< per rad
  double sole = 0.0;                  ///< per rad of the stance sole's pitch beyond sole_free_rad
  double foot_gap = 60.0;             ///< per m below the required gap
  LegVector<double> reference = LegVector<double>::Constant(1.0);  ///< per rad, shape of the joint curves
  LegVector<double> bias = LegVector<double>::Constant(1.0);       ///< per rad, of the curves' means
  double correlation = 20.0;                                       ///< per 1 short of a ShapeGoal
  double rms = 6.0;                                                ///< per rad beyond a ShapeGoal
  double amplitude = 10.0;                                         ///< per 1 short of a ShapeGoal
  double limit = 50.0;                                             ///< per rad beyond the limit
  double smooth = 2e-4;                                            ///< per rad/cycle^2
};

struct GaitTask {
  double period_s = 1.0;
  double duty_factor = 0.6;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< vx, vy [m/s], omega [rad/s] at full gain
  bool symmetric = true;                               ///< the right leg is the left one mirrored, half a cycle later
  double sway_m = 0.0;        ///< sideways movement of the base towards the stance foot at full gain
  double hike_rad = 0.0;      ///< amplitude of the base's roll at full gain, up on the swinging side
  double height_m = 0.0;      ///< mean base height at full gain, deviation from stand
  double clearance_m = 0.04;  ///< of the lowest sole point in mid swing (0.3 to 0.7 of it) at full gain
  /// Exponent of the required clearance in the last 0.3 of the swing: (sin(pi s) / sin(0.3 pi))^landing. 2 comes down
  /// gently; 1 keeps more clearance until shortly before contact, so that a leg that sags a little lands on time.
  double landing = 2.0;
  double flat_from = 0.0;  ///< start and end of the flat part of the stance, as shares of the stance
  double flat_to = 1.0;
  /// Where a stance sole shall lie flat, in cycles since initial contact, and the pitch that is free. foot_flat pulls
  /// softly over more of the stance; hip, knee and ankle, each within its ShapeGoal, can add up to a foot on its heel.
  double sole_from = 0.10, sole_to = 0.30, sole_free_rad = 0.04;
  double foot_gap_m = 0.03;        ///< between the soles, along the base's y axis
  std::vector<LegPose> reference;  ///< kClipSamples poses to stay near [rad]
  std::vector<ShapeGoal> shape;    ///< of the left leg
  std::vector<Scenario> scenarios;
  GaitWeights weights;
  /// Solves; after each, the velocity targets move by the error of the means. Iterations at most, of the first one and
  /// of each later one, which starts from the one before.
  int rounds = 4, first_iterations = 160, later_iterations = 40;
};

/// Phase of the foot relative to the middle of its stance, in [-0.5, 0.5). Stance lasts |s| <= duty_factor / 2.
double stance_phase(double phase, Foot foot, double duty_factor);

/// The base's roll at full gain: hike_rad cos(2 pi (phase - duty_factor - 0.03)), and its slope.
Roll hike(const GaitTask& task, double phase);

/// 1 in stance, 0 in swing, with cosine edges of this width centred on touch-down and lift-off.
double contact_weight(double stance_phase, double duty_factor, double edge_cycle = 0.04);

}  // namespace pmg::generator
