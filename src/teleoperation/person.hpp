// A scripted person in a headset: (what the person wants of head and hands) => the headset's messages, no faster than
// people move.
#pragma once

#include <cstdint>

#include "vr/vr_news.hpp"

namespace pmg::teleoperation {

/// Stands in the room V, looks along x. The hands' places are relative to the head.
class Person {
 public:
  static constexpr double kHeadFastest_m_s = 0.5, kHeadTurn_rad_s = 0.8, kHandFastest_m_s = 0.4, kHandTurn_rad_s = 1.0;

  Person();

  /// Where the head shall be from its centre: forward, left, up [m], turned left and bent forward [rad].
  void lean(const Eigen::Vector3d& to_m, double yaw_rad, double pitch_rad = 0.0) noexcept {
    lean_to_m_ = to_m;
    yaw_to_rad_ = yaw_rad;
    pitch_to_rad_ = pitch_rad;
  }
  /// This hand's velocity relative to the head [m/s], for now.
  void move_hand(Foot side, const Eigen::Vector3d& v_m_s) noexcept { hand_v_m_s_[side] = v_m_s; }
  /// How fast this hand turns, about axes forward, left and up [rad/s], for now.
  void turn_hand(Foot side, const Eigen::Vector3d& omega_rad_s) noexcept { hand_omega_rad_s_[side] = omega_rad_s; }
  void squeeze();
  void let_go() noexcept { news_.held = false; }
  bool squeezes() const noexcept { return news_.held; }
  void pull(Foot side);
  void release(Foot side) noexcept { news_.hands[side].leads = false; }
  bool pulls(Foot side) const noexcept { return news_.hands[side].leads; }

  /// 10 ms later: the next message.
  const vr::VrNews& next(std::int64_t now_ns);

 private:
  vr::VrNews news_;
  Eigen::Vector3d lean_m_ = Eigen::Vector3d::Zero(), lean_to_m_ = Eigen::Vector3d::Zero();
  double yaw_rad_ = 0.0, yaw_to_rad_ = 0.0, pitch_rad_ = 0.0, pitch_to_rad_ = 0.0;
  PerFoot<Eigen::Vector3d> hand_m_, hand_v_m_s_, hand_omega_rad_s_;
  PerFoot<Eigen::Quaterniond> hand_R_;
};

/// The head's displacement that asks for a share of the robot's fastest velocity, in [-1, 1] each: what a person has
/// learnt of the dead zone. An eighth of the fastest and less is no wish.
Eigen::Vector2d lean_for(const Eigen::Vector2d& share) noexcept;
double turn_for(double share) noexcept;  ///< likewise, of the head's yaw [rad]
double bend_for(double share) noexcept;  ///< likewise, of the head's pitch [rad]

}  // namespace pmg::teleoperation
