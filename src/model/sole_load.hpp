// Load of a robot's soles from the joint torques of its legs, because robots have no force sensors. No heap after
// construction; nothing keeps a reference to the robot.
#pragma once

#include <Eigen/Core>
#include <kdl/chain.hpp>
#include <vector>

#include "model/leg_kinematics.hpp"

namespace pmg::model {

struct SoleLoad {
  double force_N = 0.0;                                 ///< along the sole's normal, positive when the ground pushes
  double vertical_N = 0.0;                              ///< against gravity; positive when the ground pushes
  Eigen::Vector2d moment_Nm = Eigen::Vector2d::Zero();  ///< of the ground on the sole about its centre, its x and y
  /// Distance from the centre of pressure to the nearest edge of the sole [m]:
  ///   min(half_x - |M_y / F|, half_y - |M_x / F|).
  /// About 0 for a sole that stands on an edge, larger for one that lies flat.
  double inside_m = 0.0;
};

/// Statics of each leg in one posture: J^T f = gravity torque of the leg - joint torques, so f = (J^T)^+ (...).
/// Neglected: the leg's inertia, and joint friction, whose effect friction_N() estimates. For a leg with fewer than six
/// joints f is the smallest wrench that explains its torques.
class SoleLoads {
 public:
  explicit SoleLoads(const RobotModel& robot);

  /// Computes gravity torques and Jacobians. q [rad]: all joints. gravity_B: unit vector in the base frame.
  void set_posture(const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept;
  /// (torques of all joints in this posture [Nm]) => (loads).
  PerFoot<SoleLoad> of(const JointVector& torque_Nm) const noexcept;

  /// Error of vertical_N that friction may cause in this posture [N]:
  ///   sqrt(sum of (lift_i friction_i)^2) over the leg's joints,
  /// with robot.yaml's friction [Nm] and lift_i, joint i's rate that raises the foot by 1 m/s [rad/m]. Infinite where
  /// the torques don't determine the load, for example in a straight leg.
  double friction_N(Foot foot) const noexcept { return legs_[foot].friction_N; }

 private:
  using LegVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxLegJoints, 1>;
  using LegJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxLegJoints>;

  struct Leg {
    KDL::Chain chain;         // base -> foot link
    std::vector<int> joints;  // index of each of its joints in the robot's joint order, from the base on
    LegVector dry_friction_Nm;
    Eigen::Vector3d sole_center_F;
    Eigen::Vector2d half_sole_m;
    Eigen::Matrix3d R_BF = Eigen::Matrix3d::Identity();
    LegVector gravity_Nm;  // holds the leg against gravity
    Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxLegJoints, 6> J_inverse;  // of the Jacobian
    double friction_N = 0.0;
  };

  static Leg leg(const RobotModel& robot, Foot side);
  static void compute(Leg& leg, const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept;

  PerFoot<Leg> legs_;
  Eigen::Vector3d gravity_B_ = -Eigen::Vector3d::UnitZ();
};

}  // namespace pmg::model
