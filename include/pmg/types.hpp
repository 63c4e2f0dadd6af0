// Fixed-capacity types that every part of the generator shares.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <numbers>

namespace pmg {

inline constexpr double kGravity_m_s2 = 9.81;  ///< as MuJoCo has it
inline constexpr double kRadPerDegree = std::numbers::pi / 180.0;

/// Upper bound on a robot's joints. Vectors of this capacity live on the stack, so no step of the loop allocates.
inline constexpr int kMaxJoints = 48;

/// One number per joint, in the robot's joint order (model::JointIndex) [rad or rad/s, as the name says].
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;

enum Foot : std::size_t { kLeft = 0, kRight = 1 };

/// One value per foot, indexed by Foot.
template <typename T>
using PerFoot = std::array<T, 2>;

}  // namespace pmg
