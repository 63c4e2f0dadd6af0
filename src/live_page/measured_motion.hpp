// What a robot does of its command, from its joints and its IMU: (STATE, STATUS) => six channels, smoothed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "model/leg_kinematics.hpp"
#include "model/link_chain.hpp"
#include "model/robot_model.hpp"
#include "operator/robot_board.hpp"
#include "pmg/command.hpp"

namespace pmg::live_page {

/// Nothing measures a robot's velocity directly. The foot that carries more stands, so the pelvis moves by
///   v_H = -R_HB (v_BF + omega_B x p_BF),
/// with p_BF and v_BF of its sole's centre from the joints, omega_B and R_HB (without yaw) from the IMU. A foot that
/// slips looks like a robot that moves. Yaw rate, pitch and roll of the torso and the pelvis' height above the sole
/// likewise. All are low-passed with kSmooth_s, about a gait period. An estimate for people to look at; nothing is
/// decided by it.
class MeasuredMotion {
 public:
  static constexpr double kSmooth_s = 0.5;
  static constexpr double kPause_s = 0.5;  ///< after so long without a STATE it begins anew

  explicit MeasuredMotion(const model::RobotModel& robot);

  /// Call after each link.receive(). A STATE of another robot, or one that isn't finite, is passed over.
  void take(const ops::RobotNews& news) noexcept;
  /// As Command has them. Nothing: no STATE came yet, or neither foot carries the robot.
  const std::optional<std::array<double, kChannels>>& channels() const noexcept { return smooth_; }

  /// Of the base without its yaw: R_HB. Nothing: no STATE came yet that is whole.
  const std::optional<Eigen::Quaterniond>& tilt() const noexcept { return tilt_; }

 private:
  std::array<double, kChannels> measure(Foot stance) const noexcept;

  model::LegKinematics legs_;
  model::ChainKinematics base_to_imu_, base_to_torso_;
  Eigen::Matrix3d R_LI_;
  double standing_height_m_;
  JointVector q_, dq_;
  PerFoot<model::FootKinematics> feet_;
  Eigen::Matrix3d R_BI_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d up_B_ = Eigen::Vector3d::UnitZ(), omega_B_ = Eigen::Vector3d::Zero();
  std::int64_t stamp_ns_ = 0;
  std::optional<std::array<double, kChannels>> smooth_;
  std::optional<Eigen::Quaterniond> tilt_;
};

}  // namespace pmg::live_page
