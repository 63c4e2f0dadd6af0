// How far the torso leans from where it was told to be, seen by the IMU through the joints between them.
#pragma once

#include "model/chain_kinematics.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::control {

/// Attitude of the torso link in its heading frame: Ry(pitch) Rx(roll).
struct RollPitchAim {
  double pitch_rad = 0.0, roll_rad = 0.0;
};

class TorsoAttitude {
 public:
  /// Throws std::invalid_argument when no chain of the robot's joints leads from the IMU's link to the torso.
  explicit TorsoAttitude(const model::RobotModel& robot);

  /// Angle between the torso's vertical and the aimed one [rad], whatever the heading. state is finite and whole. No
  /// heap.
  double error_rad(const model::RobotState& state, const RollPitchAim& aim) noexcept;

 private:
  model::ChainKinematics imu_link_to_torso_;
  Eigen::Matrix3d R_LI_;  // IMU frame in its link
};

}  // namespace pmg::control
