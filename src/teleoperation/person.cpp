#include "teleoperation/person.hpp"

#include <algorithm>
#include <cmath>

#include "vr/head_motion.hpp"

namespace pmg::teleoperation {

namespace {

constexpr double kStep_s = 0.01;
constexpr double kEyes_m = 1.6;
constexpr double kLeast = 0.03;  // of the fastest: below that a person stands still

/// The stick's deflection that gives this share: shaped()'s inverse, by bisection.
double deflection(const ops::StickShape& shape, double share) noexcept {
  double low = shape.dead_zone, high = shape.full_at;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    (ops::shaped(shape, middle, 0.0)[0] < share ? low : high) = middle;
  }
  return high;
}

Eigen::Vector3d bounded(const Eigen::Vector3d& v, double most) {
  const double size = v.norm();
  return size > most ? Eigen::Vector3d(v * most / size) : v;
}

}  // namespace

Eigen::Vector2d lean_for(const Eigen::Vector2d& share) noexcept {
  const double size = share.norm();
  if (size < kLeast) return Eigen::Vector2d::Zero();
  return vr::kReach_m * deflection(vr::kStep, std::min(size, 1.0)) * share / size;
}

double turn_for(double share) noexcept {
  if (std::abs(share) < kLeast) return 0.0;
  return std::copysign(vr::kTurn_rad * deflection(vr::kTurn, std::min(std::abs(share), 1.0)), share);
}

double bend_for(double share) noexcept {
  if (std::abs(share) < kLeast) return 0.0;
  return std::copysign(vr::kTilt_rad * deflection(vr::kTilt, std::min(std::abs(share), 1.0)), share);
}

Person::Person() {
  news_.shown = true;
  hand_m_[kLeft] = {0.35, 0.2, -0.4};
  hand_m_[kRight] = {0.35, -0.2, -0.4};
  for (const Foot side : {kLeft, kRight}) {
    hand_v_m_s_[side] = hand_omega_rad_s_[side] = Eigen::Vector3d::Zero();
    hand_R_[side] = Eigen::Quaterniond::Identity();
  }
}

void Person::squeeze() {
  news_.held = true;
  ++news_.presses;
}

void Person::pull(Foot side) {
  news_.hands[side].leads = true;
  ++news_.hands[side].lead_presses;
}

const vr::VrNews& Person::next(std::int64_t now_ns) {
  const Eigen::Vector3d way_m = lean_to_m_ - lean_m_;
  const double most_m = kHeadFastest_m_s * kStep_s;
  lean_m_ += way_m.norm() > most_m ? Eigen::Vector3d(way_m.normalized() * most_m) : way_m;
  const double most_rad = kHeadTurn_rad_s * kStep_s;
  yaw_rad_ += std::clamp(yaw_to_rad_ - yaw_rad_, -most_rad, most_rad);
  pitch_rad_ += std::clamp(pitch_to_rad_ - pitch_rad_, -most_rad, most_rad);
  ++news_.number;
  news_.stamp_ns = now_ns;
  news_.head = vr::Pose{.p_m = lean_m_ + Eigen::Vector3d(0.0, 0.0, kEyes_m),
                        .R = Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch_rad_, Eigen::Vector3d::UnitY())};
  for (const Foot side : {kLeft, kRight}) {
    hand_m_[side] += kStep_s * bounded(hand_v_m_s_[side], kHandFastest_m_s);
    const Eigen::Vector3d turn_rad = kStep_s * bounded(hand_omega_rad_s_[side], kHandTurn_rad_s);
    const double angle_rad = turn_rad.norm();
    if (angle_rad > 0.0)
      hand_R_[side] = (Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad) * hand_R_[side]).normalized();
    news_.hands[side].pose = vr::Pose{.p_m = news_.head->p_m + hand_m_[side], .R = hand_R_[side]};
  }
  return news_;
}

}  // namespace pmg::teleoperation
