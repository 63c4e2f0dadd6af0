// The torso's deviation from its commanded attitude, from the IMU and the joints between IMU and torso.
#pragma once

#include "model/chain_kinematics.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::faults {

/// Attitude of the torso link in its heading frame: Ry(pitch) Rx(roll).
struct RollPitchAim {
  double pitch_rad = 0.0, roll_rad = 0.0;
};

class TorsoAttitude {
 public:
  /// Throws std::invalid_argument when no chain of the robot's joints leads from the IMU's link to the torso.
  explicit TorsoAttitude(const model::RobotModel& robot);

  /// (state, commanded pitch and roll) => (angle between the torso's measured and commanded vertical [rad]):
  /// acos(z_T . (Ry(pitch) Rx(roll))^T z), independent of the heading. state must be finite and whole. No heap.
  double error_rad(const model::RobotState& state, const RollPitchAim& aim) noexcept;

 private:
  model::ChainKinematics imu_link_to_torso_;
  Eigen::Matrix3d R_LI_;  // IMU frame in its link
};

}  // namespace pmg::faults
