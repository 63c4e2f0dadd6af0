// What standing on level ground with both soles says about joint angles and the IMU: five equations a pose.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/chain_kinematics.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::zero {

/// Both soles' tilts [rad], and how much higher the left one is [m].
using StandingMiss = Eigen::Matrix<double, 5, 1>;

/// The joints whose zero points it can say something about are those between the soles and between pelvis and IMU: no
/// other moves a sole against the IMU.
class StandingConstraint {
 public:
  explicit StandingConstraint(const model::RobotModel& robot);

  const std::vector<int>& joints() const { return joints_; }  ///< ascending, in the robot's order

  /// imu_tilt_rad: the IMU's mounting about its own x and y beyond robot.yaml's. gravity_I: unit vector.
  StandingMiss miss(const JointVector& q, const Eigen::Vector3d& gravity_I, const Eigen::Vector2d& imu_tilt_rad);

  /// Of miss by joints(), then by the IMU's tilt.
  Eigen::Matrix<double, 5, Eigen::Dynamic> jacobian(const JointVector& q, const Eigen::Vector3d& gravity_I,
                                                    const Eigen::Vector2d& imu_tilt_rad);

  /// s of the paper as the simulated robot's IMU shows it when it stands flat on one foot: gravity, in the IMU's frame.
  PerFoot<Eigen::Vector3d> gravity_of_simulated(const JointVector& q, const Eigen::Vector2d& imu_tilt_rad);

  /// In the base frame.
  Eigen::Vector3d gravity_B(const JointVector& q, const Eigen::Vector3d& gravity_I);

 private:
  Eigen::Matrix3d R_BI(const JointVector& q, const Eigen::Vector2d& imu_tilt_rad);

  model::LegKinematics legs_;
  model::ChainKinematics imu_chain_;
  Eigen::Matrix3d R_LI_;
  std::vector<int> joints_;
};

}  // namespace pmg::zero
