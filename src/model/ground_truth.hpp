// The true state of a robot, which only a simulation knows.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace pmg::model {

/// For metrics, logs and pictures, never for control. Frames: world W, base B, torso T. [m], [m/s], [rad/s].
struct GroundTruth {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_WB_B = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WT = Eigen::Quaterniond::Identity();  ///< torso link
  std::array<double, 2> foot_force_N{};                      ///< normal force, left and right
  std::array<double, 2> foot_slip_m_s{};  ///< horizontal speed of the contact point, 0 when in the air
};

}  // namespace pmg::model
