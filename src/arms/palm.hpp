// Types of one arm. Everything is in the torso link's frame T: x forward, y left, z up, origin at the torso link.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "pmg/types.hpp"

namespace pmg::arms {

inline constexpr int kMaxArmJoints = 8;

/// One value for each joint of an arm, from the shoulder on.
using ArmVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxArmJoints, 1>;
using ArmMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxArmJoints, kMaxArmJoints>;

/// One value for each arm, indexed by kLeft and kRight as feet are.
template <typename T>
using PerArm = PerFoot<T>;

/// Where a palm is: T_TP.
struct PalmPose {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();          ///< [m] in T
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();  ///< R_TP
};

/// The rotation vector that turns one orientation into another, in T [rad]: log(R_to R_from^T).
inline Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine < 1e-12) return 2.0 * turn.vec();
  return (2.0 * std::atan2(sine, turn.w()) / sine) * turn.vec();
}

}  // namespace pmg::arms
