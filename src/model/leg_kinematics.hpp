// Forward kinematics and Jacobian of both legs on their KDL chains; the base attitude for a given torso attitude. No
// heap after construction; nothing keeps a reference to the robot.
#pragma once

#include <Eigen/Core>
#include <array>

#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::model {

inline constexpr int kMaxLegJoints = 8;

/// Pose, velocity and Jacobian of a foot link relative to the base frame B.
struct FootKinematics {
  Eigen::Matrix3d R_BF = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_BF = Eigen::Vector3d::Zero();  ///< foot link origin [m]
  /// 6 x n for the leg's n joints, in B: rows 0-2 linear velocity of the foot link's origin [m/rad], rows 3-5 angular
  /// velocity.
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxLegJoints> J;
  Eigen::Vector3d v_BF = Eigen::Vector3d::Zero();      ///< J * dq, linear [m/s], in B
  Eigen::Vector3d omega_BF = Eigen::Vector3d::Zero();  ///< J * dq, angular [rad/s], in B
  std::array<Eigen::Vector3d, 4> sole_B;               ///< sole corners in B [m]
};

class LegKinematics {
 public:
  explicit LegKinematics(const RobotModel& robot);

  /// (q, dq) => (feet). q, dq: all joints of the robot [rad], [rad/s].
  const PerFoot<FootKinematics>& compute(const JointVector& q, const JointVector& dq) noexcept;

 private:
  PerFoot<ChainKinematics> chains_;
  PerFoot<std::array<Eigen::Vector3d, 4>> sole_corners_F_;
  PerFoot<FootKinematics> feet_;
};

/// Orientation of the base in the heading frame H for a pitch and roll of the torso. R_HB is such that the torso link's
/// attitude is Rz(yaw) Ry(pitch) Rx(roll) and the base's own yaw is zero:
///   R_HB = Rz(yaw) Ry(pitch) Rx(roll) R_BT(q)^T,
///   omega_HB = Rz(yaw) (pitch rate * y + Ry(pitch) roll rate * x) - omega_BT, its z component set to zero.
/// q: all joints [rad]. No heap. With all torso joints at zero, R_HB is Ry(pitch) Rx(roll).
class BaseAttitude {
 public:
  explicit BaseAttitude(const RobotModel& robot);
  struct Result {
    Eigen::Matrix3d R_HB = Eigen::Matrix3d::Identity();
    Eigen::Vector3d omega_HB_H = Eigen::Vector3d::Zero();  ///< pitch and roll rates, z component zero [rad/s]
  };
  Result compute(const JointVector& q, const JointVector& dq, double pitch_rad, double roll_rad,
                 double pitch_rate_rad_s, double roll_rate_rad_s) noexcept;

 private:
  ChainKinematics torso_;
};

}  // namespace pmg::model
