// Motion clips (paper III-A.1): D_d-clip = {q, dq, v, omega, c = {mu, r}, T} (eq. 3) and D_s = {q, p, r, h} (eq. 2).
// Plain data, filled by model::load_clip_library (src/model/clip_library_file.hpp).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pmg/command.hpp"
#include "pmg/command_inverse.hpp"
#include "pmg/types.hpp"

namespace pmg {

/// One gait cycle of a movement in one direction. Sample k of N is at phase k/N; the end is not repeated. Phase 0 is
/// the left foot's initial contact.
struct DynamicClip {
  std::vector<JointVector> q;        ///< N samples [rad]
  std::vector<JointVector> dq_dphi;  ///< N samples: derivative with respect to phase [rad per cycle]
  double period_s = 0.0;             ///< T
  PerFoot<double> contact_center{};  ///< mu, phase in [0, 1)
  PerFoot<double> duty_factor{};     ///< r in (0, 1]
  std::array<double, kVelocityChannels>
      mean_velocity{};  ///< vx, vy [m/s], omega [rad/s] of the stance feet's kinematics
  /// The same cycle at half gain, as many samples [rad], [rad per cycle]; empty: midway between q_stand and q
  /// (half_gain.hpp).
  std::vector<JointVector> half_q, half_dq_dphi;
};

/// Joint angles of one posture channel as a function of its command; linear between rows.
struct StaticClip {
  std::vector<double> command;  ///< strictly increasing deviation from stand [rad or m]; the range contains 0
  std::vector<JointVector> q;   ///< one per command [rad]; at command 0 it is q_stand
};

/// Joint i's counterpart under reflection in the sagittal plane: q_mirrored[i] = sign[i] * q[partner[i]].
struct MirrorMap {
  std::vector<int> partner;
  std::vector<double> sign;
};

/// How the generator mixes clips (blending.hpp).
enum class Blend {
  kGain,     ///< g_i = n_i / max(1, sum n), q_d = sum g_i q_i + (1 - sum g_i) q_stand
  kPaper,    ///< the paper's w and alpha literally (eq. 4 to 7)
  kCorners,  ///< multilinear between clips at the corners of the command box: combined commands keep their amplitude
};
inline constexpr std::array<const char*, 3> kBlendNames = {"gain", "paper", "corners"};

/// A clip of several velocities at once, each at full amplitude: a walked circle, for example.
struct CornerClip {
  std::array<int, kVelocityChannels> sign{};  ///< of vx, vy, omega: -1, 0 or 1; at least two aren't 0
  DynamicClip clip;
};

/// u_max_i: the speed of a clip at gain 1, by direction; positive numbers [m/s, rad/s].
struct VelocityScale {
  std::array<double, kVelocityChannels> negative{}, positive{};
};

/// Everything the generator blends. If vy or omega lacks the clip of one direction, the generator mirrors the other's.
struct ClipLibrary {
  std::array<std::optional<DynamicClip>, kVelocityChannels> positive;  ///< vx, vy, omega > 0
  std::array<std::optional<DynamicClip>, kVelocityChannels> negative;  ///< vx, vy, omega < 0
  std::vector<CornerClip> corners;    ///< for Blend::kCorners; corner_clips.hpp makes missing ones
  std::array<StaticClip, 3> posture;  ///< pitch, roll, height
  JointVector q_stand;                ///< [rad]
  JointVector q_lower, q_upper;       ///< joint limits [rad]
  MirrorMap mirror;
  Blend blend = Blend::kGain;                   ///< the rule that the library was made for
  std::optional<VelocityScale> velocity_scale;  ///< of clips that differ from robot.yaml's; goes before the options'
  CommandInverse inverse;                       ///< made for that rule; empty: commands stay as they are
};

}  // namespace pmg
