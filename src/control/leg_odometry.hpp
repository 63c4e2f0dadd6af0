// Velocity of a walking robot from its legs and its IMU: the base moves as the feet that carry stand still.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "model/chain_kinematics.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

class LegOdometry {
 public:
  explicit LegOdometry(const model::RobotModel& robot);

  /// (state, weight of each foot) => (vx, vy of the base's origin in its heading frame [m/s], yaw rate [rad/s]). The
  /// lowest point of a sole stands still, feet by their weights. Nothing where no foot has a weight, or the state isn't
  /// finite. No heap.
  std::optional<std::array<double, kVelocityChannels>> velocity_H(const model::RobotState& state,
                                                                  const PerFoot<double>& weight) noexcept;

 private:
  model::LegKinematics legs_;
  model::ChainKinematics base_to_imu_link_;
  Eigen::Matrix3d R_LI_;
};

}  // namespace pmg::control
