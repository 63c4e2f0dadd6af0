// (where the head is, relative to where it was centred) => velocity and posture.
#pragma once

#include <array>
#include <optional>

#include "operator/stick_shape.hpp"
#include "pmg/command.hpp"
#include "vr/vr_news.hpp"

namespace pmg::vr {

/// The head's pose when the operator said so: from there on displacements count.
struct Centre {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;

  /// A vector of V in the centre's heading frame C.
  Eigen::Vector3d in_heading(const Eigen::Vector3d& v_V) const {
    return Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()) * v_V;
  }
  Eigen::Quaterniond in_heading(const Eigen::Quaterniond& R_V) const {
    return Eigen::Quaterniond(Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ())) * R_V;
  }
};
/// Nothing: the head looks straight up or down.
std::optional<Centre> centre_of(const Pose& head) noexcept;

/// Each is a share in [-1, 1] of what the robot can, 0 within its dead zone:
///   vx, vy: displacement in C over kReach_m, radially;  omega: yaw over kTurn_rad;
///   pitch, roll: tilt over kTilt_rad;  height: metres up or down beyond kHeightDead_m, as they are.
struct HeadAsks {
  std::array<double, kChannels> share{};  ///< height [m]
  bool neutral() const noexcept;
};

inline constexpr double kReach_m = 0.35, kTurn_rad = 0.9, kTilt_rad = 0.6, kHeightDead_m = 0.06;
inline constexpr ops::StickShape kStep = {.dead_zone = 0.3, .full_at = 1.0, .expo = 0.3};  // 0.105 m
inline constexpr ops::StickShape kTurn = {.dead_zone = 0.3, .full_at = 1.0, .expo = 0.3};  // 15 degrees
inline constexpr ops::StickShape kTilt = {.dead_zone = 0.3, .full_at = 1.0, .expo = 0.3};  // 10 degrees

/// Nothing: the head looks straight up or down, where its yaw is unknown.
std::optional<HeadAsks> head_asks(const Centre& centre, const Pose& head) noexcept;

}  // namespace pmg::vr
