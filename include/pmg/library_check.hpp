// Checks of a clip library and of the generator's options; each throws std::invalid_argument with the expected value.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "pmg/blending.hpp"
#include "pmg/clip.hpp"
#include "pmg/command.hpp"
#include "pmg/phase.hpp"

namespace pmg::check {

inline constexpr std::size_t kMinSamples = 8;            ///< fewer can't hold the shape of a step
inline constexpr double kMaxContactCenterSpread = 0.15;  ///< of one foot's mu [cycles]: else no stance to average
inline constexpr double kMaxStandDifference_rad = 0.01;  ///< of a static clip's row at command 0 from the stand

inline void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

/// For example "clip vx_m_s > 0, omega_rad_s < 0".
inline std::string corner_name(std::size_t c) {
  std::string name;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const int sign = kCornerTable[c].sign[channel];
    if (sign == 0) continue;
    name += (name.empty() ? "clip " : ", ") + std::string(kChannelNames[channel]) + (sign > 0 ? " > 0" : " < 0");
  }
  return name;
}

inline void joint_vector(const JointVector& q, Eigen::Index joints, const std::string& name) {
  require(q.size() == joints,
          name + " has " + std::to_string(q.size()) + " joints; expected " + std::to_string(joints));
  require(q.allFinite(), name + " is not finite; expected radians");
}

inline void stand_and_limits(const ClipLibrary& library, double margin_rad) {
  const Eigen::Index joints = library.q_stand.size();
  require(joints > 0, "q_stand is empty; expected one angle a joint");
  joint_vector(library.q_stand, joints, "q_stand");
  joint_vector(library.q_lower, joints, "q_lower");
  joint_vector(library.q_upper, joints, "q_upper");
  for (Eigen::Index i = 0; i < joints; ++i) {
    require(
        library.q_stand[i] >= library.q_lower[i] + margin_rad && library.q_stand[i] <= library.q_upper[i] - margin_rad,
        "q_stand[" + std::to_string(i) + "] = " + std::to_string(library.q_stand[i]) + " rad; expected at least " +
            std::to_string(margin_rad) + " rad inside the joint's limits");
  }
}

inline void dynamic_clip(const DynamicClip& clip, Eigen::Index joints, const std::string& name) {
  require(clip.q.size() >= kMinSamples, name + " has " + std::to_string(clip.q.size()) +
                                            " samples; expected at least " + std::to_string(kMinSamples));
  require(clip.dq_dphi.size() == clip.q.size(), name + ": dq_dphi has another number of samples than q");
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    joint_vector(clip.q[k], joints, name + ": q[" + std::to_string(k) + "]");
    joint_vector(clip.dq_dphi[k], joints, name + ": dq_dphi[" + std::to_string(k) + "]");
  }
  require(clip.half_q.empty() || clip.half_q.size() == clip.q.size(),
          name + ": half_q has another number of samples than q; expected as many, or none");
  require(clip.half_dq_dphi.size() == clip.half_q.size(),
          name + ": half_dq_dphi has another number of samples than half_q");
  for (std::size_t k = 0; k < clip.half_q.size(); ++k) {
    joint_vector(clip.half_q[k], joints, name + ": half_q[" + std::to_string(k) + "]");
    joint_vector(clip.half_dq_dphi[k], joints, name + ": half_dq_dphi[" + std::to_string(k) + "]");
  }
  require(std::isfinite(clip.period_s) && clip.period_s > 0.0, name + ": period_s; expected more than 0");
  for (const Foot foot : {kLeft, kRight}) {
    require(clip.contact_center[foot] >= 0.0 && clip.contact_center[foot] < 1.0,
            name + ": contact_center; expected a phase in [0, 1)");
    require(clip.duty_factor[foot] > 0.0 && clip.duty_factor[foot] <= 1.0, name + ": duty_factor; expected in (0, 1]");
  }
}

inline void contact_centers(const PerCorner<std::optional<DynamicClip>>& clips) {
  for (std::size_t a = 0; a < kCorners; ++a) {
    for (std::size_t b = a + 1; b < kCorners; ++b) {
      if (!clips[a] || !clips[b]) continue;
      for (const Foot foot : {kLeft, kRight}) {
        const double apart = std::abs(wrap_half_cycle(clips[a]->contact_center[foot] - clips[b]->contact_center[foot]));
        require(apart <= kMaxContactCenterSpread,
                corner_name(a) + " and " + corner_name(b) + ": contact centres of one foot differ by " +
                    std::to_string(apart) + " cycles; expected at most " + std::to_string(kMaxContactCenterSpread));
      }
    }
  }
}

inline void static_clip(const StaticClip& clip, const JointVector& q_stand, const std::string& name) {
  require(clip.q.size() == clip.command.size(), name + ": another number of postures than of commands");
  if (clip.command.empty()) return;
  require(clip.command.front() <= 0.0 && clip.command.back() >= 0.0, name + ": command range; expected to contain 0");
  for (std::size_t row = 0; row < clip.command.size(); ++row) {
    require(std::isfinite(clip.command[row]) && (row == 0 || clip.command[row] > clip.command[row - 1]),
            name + ": command; expected to increase from row to row");
    joint_vector(clip.q[row], q_stand.size(), name + ": q[" + std::to_string(row) + "]");
    require(clip.command[row] != 0.0 || (clip.q[row] - q_stand).cwiseAbs().maxCoeff() <= kMaxStandDifference_rad,
            name + ": q at command 0; expected the standing posture");
  }
}

inline void mirror_map(const MirrorMap& mirror, Eigen::Index joints) {
  const auto n = static_cast<std::size_t>(joints);
  require(mirror.partner.size() == n && mirror.sign.size() == n, "mirror: expected one partner and one sign a joint");
  for (std::size_t i = 0; i < n; ++i) {
    const int partner = mirror.partner[i];
    require(
        partner >= 0 && partner < joints && mirror.partner[static_cast<std::size_t>(partner)] == static_cast<int>(i),
        "mirror: partner of joint " + std::to_string(i) + "; expected joints paired both ways");
    require(std::abs(mirror.sign[i]) == 1.0 && mirror.sign[i] == mirror.sign[static_cast<std::size_t>(partner)],
            "mirror: sign of joint " + std::to_string(i) + "; expected 1 or -1, the same for both partners");
  }
}

inline void command_limits(const CommandLimits& limits) {
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const std::string name = std::string("limits of ") + kChannelNames[channel];
    require(std::isfinite(limits.lower[channel]) && std::isfinite(limits.upper[channel]) &&
                limits.lower[channel] <= 0.0 && limits.upper[channel] >= 0.0,
            name + ": expected a range that contains 0");
    require(std::isfinite(limits.rate_per_s[channel]) && limits.rate_per_s[channel] >= 0.0,
            name + ": rate; expected 0 or more");
  }
}

}  // namespace pmg::check
