// Clips that say how they look at half gain: between rest, half and full gain every joint follows a parabola.
#pragma once

#include <cstddef>

#include "pmg/clip.hpp"
#include "pmg/types.hpp"

namespace pmg {

inline bool has_half_gain(const DynamicClip& clip) noexcept { return !clip.half_q.empty(); }

/// With d = q - q_stand and h = half_q - q_stand a clip deviates from q_stand at gain g by the parabola through 0, h
/// and d at g = 0, 1/2 and 1:
///   g d + 4 g (1 - g) b,  b = h - d / 2.
/// Angles of a straight line g d don't keep both feet on the ground: a leg's length depends on the square of its
/// angles. So the feet are apart by about g (1 - g) times a function of phase, which b takes away at every gain.
/// This is the factor of b.
inline double bend_gain(double gain) noexcept { return 4.0 * gain * (1.0 - gain); }

/// b in place of q and half_q; the clip must have half_q.
inline DynamicClip bend_of(const DynamicClip& clip, const JointVector& q_stand) {
  DynamicClip bend = clip;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    bend.q[k] = clip.half_q[k] - 0.5 * (clip.q[k] + q_stand);
    bend.dq_dphi[k] = clip.half_dq_dphi[k] - 0.5 * clip.dq_dphi[k];
  }
  bend.half_q.clear();
  bend.half_dq_dphi.clear();
  return bend;
}

/// The clip blended with standing at this gain alone.
inline DynamicClip at_gain(const DynamicClip& clip, const JointVector& q_stand, double gain) {
  DynamicClip out = clip;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    out.q[k] = q_stand + gain * (clip.q[k] - q_stand);
    out.dq_dphi[k] = gain * clip.dq_dphi[k];
    if (!has_half_gain(clip)) continue;
    out.q[k] += bend_gain(gain) * (clip.half_q[k] - 0.5 * (clip.q[k] + q_stand));
    out.dq_dphi[k] += bend_gain(gain) * (clip.half_dq_dphi[k] - 0.5 * clip.dq_dphi[k]);
  }
  out.half_q.clear();
  out.half_dq_dphi.clear();
  return out;
}

}  // namespace pmg
