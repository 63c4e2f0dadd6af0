// Data on the bus: the robot's state and its command. Fixed capacity, trivially exchangeable.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "pmg/types.hpp"

namespace pmg::model {

/// The measurements of a robot. It has no true base velocity, height or contact force.
struct RobotState {
  std::int64_t stamp_ns = 0;     ///< by the Clock of the run, of the oldest motor's part
  std::int64_t age_ns = 0;       ///< of that part when the bus cycle gave it; stamp_ns contains it
  std::uint64_t bus_sample = 0;  ///< counts bus cycles
  JointVector q, dq, tau;        ///< [rad], [rad/s], [Nm]
  JointVector temperature_degC;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();                ///< in the IMU frame
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();         ///< specific force, in the IMU frame
  Eigen::Quaterniond orientation_WI = Eigen::Quaterniond::Identity();  ///< the IMU's own estimate
};

/// The drives' command: tau = kp (q - q_meas) + kd (dq - dq_meas) + tau_ff, held until the next command.
struct JointCommand {
  std::uint64_t bus_sample = 0;       ///< of the state that the command was computed from
  JointVector q, dq, kp, kd, tau_ff;  ///< [rad], [rad/s], [Nm/rad], [Nm s/rad], [Nm]
};

}  // namespace pmg::model
