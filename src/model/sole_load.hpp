// How a robot's soles are loaded, from its legs' joint torques: nobody has force sensors. No heap after construction;
// nothing keeps a reference to the robot.
#pragma once

#include <Eigen/Core>
#include <kdl/chain.hpp>
#include <vector>

#include "model/leg_kinematics.hpp"

namespace pmg::model {

struct SoleLoad {
  double force_N = 0.0;                                 ///< along the sole's normal, positive when the ground pushes
  double vertical_N = 0.0;                              ///< against gravity, likewise
  Eigen::Vector2d moment_Nm = Eigen::Vector2d::Zero();  ///< of the ground on the sole about its centre, its x and y
  /// From the centre of pressure to the nearest edge of the sole [m]: a sole that stands on an edge has it there, one
  /// that lies flat inside.
  double inside_m = 0.0;
};

/// Statics of each leg in one posture: J^T f = gravity torque of the leg - joint torques. Left out: the leg's inertia,
/// and joint friction, whose error friction_N() tells. A leg with fewer than six joints gives the smallest f that
/// explains its torques.
class SoleLoads {
 public:
  explicit SoleLoads(const RobotModel& robot);

  /// q [rad]: all joints. gravity_B: unit vector in the base frame.
  void set_posture(const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept;
  /// torque_Nm: of all joints, in this posture.
  PerFoot<SoleLoad> of(const JointVector& torque_Nm) const noexcept;

  /// How far friction may falsify vertical_N in this posture [N]: robot.yaml's in every joint of the leg, over its
  /// lever, root of the sum of squares. Infinite where the torques don't tell the load, as of a straight leg.
  double friction_N(Foot foot) const noexcept { return legs_[foot].friction_N; }

 private:
  using LegVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxLegJoints, 1>;
  using LegJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxLegJoints>;

  struct Leg {
    KDL::Chain chain;         // base -> foot link
    std::vector<int> joints;  // index in the robot's joint order of each of its joints, from the base on
    LegVector dry_friction_Nm;
    Eigen::Vector3d sole_center_F;
    Eigen::Vector2d half_sole_m;
    Eigen::Matrix3d R_BF = Eigen::Matrix3d::Identity();
    LegVector gravity_Nm;                                                                   // holds the leg
    Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxLegJoints, 6> J_inverse;  // pseudo-inverse
    double friction_N = 0.0;
  };

  static Leg leg(const RobotModel& robot, Foot side);
  static void compute(Leg& leg, const JointVector& q, const Eigen::Vector3d& gravity_B) noexcept;

  PerFoot<Leg> legs_;
  Eigen::Vector3d gravity_B_ = -Eigen::Vector3d::UnitZ();
};

}  // namespace pmg::model
