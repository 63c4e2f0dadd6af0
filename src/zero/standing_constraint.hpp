// Constraint of standing on level ground with both soles: five equations per pose for joint angles and IMU.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/chain_kinematics.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::zero {

/// Tilts of both soles [rad], and height of the left sole above the right one [m].
using StandingMiss = Eigen::Matrix<double, 5, 1>;

/// Only the zero points of joints between the soles, or between pelvis and IMU, are observable: no other joint moves a
/// sole relative to the IMU.
class StandingConstraint {
 public:
  explicit StandingConstraint(const model::RobotModel& robot);

  const std::vector<int>& joints() const { return joints_; }  ///< ascending, in the robot's order

  /// imu_tilt_rad: mounting error of the IMU against robot.yaml, about its x and y. gravity_I: unit vector, IMU frame.
  StandingMiss miss(const JointVector& q, const Eigen::Vector3d& gravity_I, const Eigen::Vector2d& imu_tilt_rad);

  /// Derivative of miss by joints(), then by the IMU's tilt.
  Eigen::Matrix<double, 5, Eigen::Dynamic> jacobian(const JointVector& q, const Eigen::Vector3d& gravity_I,
                                                    const Eigen::Vector2d& imu_tilt_rad);

  /// s of the paper, simulated: gravity in the IMU frame while the robot stands flat on one foot, for each foot.
  PerFoot<Eigen::Vector3d> gravity_of_simulated(const JointVector& q, const Eigen::Vector2d& imu_tilt_rad);

  /// Gravity's direction in the base frame.
  Eigen::Vector3d gravity_B(const JointVector& q, const Eigen::Vector3d& gravity_I);

 private:
  Eigen::Matrix3d R_BI(const JointVector& q, const Eigen::Vector2d& imu_tilt_rad);

  model::LegKinematics legs_;
  model::ChainKinematics imu_chain_;
  Eigen::Matrix3d R_LI_;
  std::vector<int> joints_;
};

}  // namespace pmg::zero
