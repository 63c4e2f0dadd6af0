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

/// How a robot moves in one moment. Vectors are in the base frame.
struct LegMotion {
  const JointVector& q;              ///< [rad], all joints
  const JointVector& dq;             ///< [rad/s]
  const JointVector& ddq;            ///< [rad/s^2]
  Eigen::Vector3d gravity_B;         ///< unit vector
  Eigen::Vector3d specific_force_B;  ///< acceleration of the base less gravity [m/s^2], as an accelerometer reads it
  Eigen::Vector3d omega_B;           ///< angular velocity of the base [rad/s]
  Eigen::Vector3d alpha_B;           ///< angular acceleration of the base [rad/s^2]
};

/// Equilibrium of each leg in one moment: J^T f = torques that hold and move the leg itself - joint torques, so
/// f = (J^T)^+ (...). Neglected: joint friction; error_N() estimates what it and inertia that isn't known exactly do.
/// For a leg with fewer than six joints f is the smallest wrench that explains its torques.
class SoleLoads {
 public:
  explicit SoleLoads(const RobotModel& robot);

  /// Computes the legs' own torques and Jacobians, of legs that are still. q [rad]: all joints. gravity_B: unit vector
  /// in the base frame.
  void set_posture(const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept;
  /// The same of legs that move. Keeps no reference.
  void set_motion(const LegMotion& motion) noexcept;
  /// (torques of all joints in this posture [Nm]) => (loads).
  PerFoot<SoleLoad> of(const JointVector& torque_Nm) const noexcept;

  /// Standard error of vertical_N in this posture [N], of dry friction and of inertia torques that are wrong:
  ///   sqrt(sum of lift_i^2 (friction_i^2 + (inertia_i acceleration_i)^2)) over the leg's joints,
  /// with robot.yaml's friction [Nm]; lift_i, joint i's rate that raises the foot by 1 m/s [rad/m]; and inertia_i: the
  /// armature, and the links below as a point at their centre of mass [kg m^2]. acceleration_rad_s2: of each joint, how
  /// much of it may be wrong. Infinite where the torques don't determine the load, for example in a straight leg.
  double error_N(Foot foot, const JointVector& acceleration_rad_s2) const noexcept;

 private:
  using LegVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxLegJoints, 1>;
  using LegJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxLegJoints>;

  struct Leg {
    KDL::Chain chain;         // base -> foot link
    std::vector<int> joints;  // index of each of its joints in the robot's joint order, from the base on
    LegVector dry_friction_Nm, armature_kg_m2;
    Eigen::Vector3d sole_center_F;
    Eigen::Vector2d half_sole_m;
    Eigen::Matrix3d R_BF = Eigen::Matrix3d::Identity();
    LegVector own_Nm;  // holds and moves the leg itself
    LegVector lift_rad_m, inertia_kg_m2;
    Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxLegJoints, 6> J_inverse;  // of the Jacobian
    bool lifts = false;  // whether the joints can raise the foot, and so the torques determine its load
  };

  static Leg leg(const RobotModel& robot, Foot side);
  static void compute(Leg& leg, const LegMotion& motion) noexcept;

  PerFoot<Leg> legs_;
  JointVector still_;  // zeros
  Eigen::Vector3d gravity_B_ = -Eigen::Vector3d::UnitZ();
};

}  // namespace pmg::model
