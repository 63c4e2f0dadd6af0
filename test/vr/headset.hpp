// A headset on a person's head, as its messages tell it: in the room V, x forward, y left, z up.
#pragma once

#include <cstdint>
#include <optional>

#include "vr/vr_news.hpp"

namespace pmg::test {

inline Eigen::Quaterniond turned(double yaw, double pitch = 0.0, double roll = 0.0) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

struct Headset {
  vr::VrNews news = [] {
    vr::VrNews all;
    all.shown = true;
    all.head = vr::Pose{.p_m = {0.3, -0.2, 1.7}, .R = turned(0.5)};  // it stands and looks anywhere
    all.hands[kLeft].pose = vr::Pose{.p_m = {0.7, 0.2, 1.2}, .R = turned(0.5)};
    all.hands[kRight].pose = vr::Pose{.p_m = {0.9, -0.2, 1.2}, .R = turned(0.5)};
    return all;
  }();
  std::int64_t delay_ns = 0;

  vr::VrNews next(std::int64_t now_ns) {
    ++news.number;
    news.stamp_ns = now_ns + 55'000'000'000 - delay_ns;
    return news;
  }
  void squeeze() {
    news.held = true;
    ++news.presses;
  }
  void let_go() { news.held = false; }
  void pull(Foot side) {
    news.hands[side].leads = true;
    ++news.hands[side].lead_presses;
  }
  void release(Foot side) { news.hands[side].leads = false; }
  /// Head and hands, in the heading that it has had from the beginning.
  void step(double forward_m, double left_m, double up_m = 0.0) {
    const Eigen::Vector3d d = turned(0.5) * Eigen::Vector3d(forward_m, left_m, up_m);
    news.head->p_m += d;
    for (vr::HandNews& hand : news.hands)
      if (hand.pose) hand.pose->p_m += d;
  }
  void move(Foot side, const Eigen::Vector3d& by_m) { news.hands[side].pose->p_m += turned(0.5) * by_m; }
};

}  // namespace pmg::test
