// What a headset says, read strictly: (text of a message) => poses, buttons and counts, in the project's axes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pmg/types.hpp"

namespace pmg::vr {

/// Of a head or a controller in the room V: x forward, y left, z up, all as the headset's system has set them.
struct Pose {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
};

/// Turn about z of what looks along x [rad]. Nothing: it looks straight up or down.
std::optional<double> yaw_of(const Eigen::Quaterniond& R) noexcept;

struct HandNews {
  std::optional<Pose> pose;       ///< nothing: it isn't tracked
  bool leads = false;             ///< the trigger is held
  std::int64_t lead_presses = 0;  ///< counts since the page was opened
  std::int64_t hand_backs = 0;    ///< likewise: how often the arm was given back to the gait
};

struct VrNews {
  std::int64_t number = 0;    ///< increases with each message of a connection
  std::int64_t stamp_ns = 0;  ///< by the headset's clock, whose zero is anywhere
  bool shown = false;         ///< the page has the eyes and the controllers; false behind the system's own menu
  std::optional<Pose> head;   ///< nothing: it isn't tracked
  PerFoot<HandNews> hands;
  bool held = false;  ///< a grip is squeezed
  // Counts since the page was opened:
  std::int64_t presses = 0;      ///< of the grips
  std::int64_t recentres = 0;    ///< the operator's, and the system's own
  std::int64_t spans_shown = 0;  ///< how often the operator has shown the span of the arms
  std::int64_t uprights = 0;     ///< how often the posture was asked back to neutral
};

/// {"vr": 7, "t": 1234.5, "shown": true, "head": POSE, "left": HAND, "right": HAND, "held": true, "presses": 2,
/// "recentres": 0, "spans": 0, "uprights": 0}, t in ms; POSE: null or [x, y, z, qx, qy, qz, qw] in WebXR's axes (x
/// right, y up, z back), m; HAND: {"pose": POSE, "leads": false, "presses": 0, "backs": 0}. Nothing: anything else,
/// whatever it is. A position is within 20 m of the origin, a quaternion's length within 1 % of 1; it is made 1. Safe
/// for foreign bytes.
std::optional<VrNews> read_news(std::string_view text);

}  // namespace pmg::vr
