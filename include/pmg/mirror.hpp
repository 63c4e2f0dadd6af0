// Reflection of a clip in the sagittal plane: a step to the left becomes a step to the right.
#pragma once

#include <cstddef>

#include "pmg/clip.hpp"
#include "pmg/clip_sampling.hpp"
#include "pmg/phase.hpp"

namespace pmg {

inline JointVector mirrored(const MirrorMap& mirror, const JointVector& q) {
  JointVector reflected(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    reflected[i] = mirror.sign[joint] * q[mirror.partner[joint]];
  }
  return reflected;
}

/// q_m(phi)[i] = sign[i] q(phi + 0.5)[partner[i]]. The half cycle keeps phase 0 at the left foot's initial contact.
/// Contacts swap sides; vy and omega change sign.
inline DynamicClip mirrored(const MirrorMap& mirror, const DynamicClip& clip) {
  DynamicClip reflected = clip;
  const ClipCurve curve(clip);
  JointVector q(curve.joints()), dq_dphi(curve.joints());
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    // Interpolated: half a cycle is no whole number of samples when N is odd.
    curve.sample(wrap_cycle(static_cast<double>(k) / static_cast<double>(clip.q.size()) + 0.5), q, dq_dphi);
    reflected.q[k] = mirrored(mirror, q);
    reflected.dq_dphi[k] = mirrored(mirror, dq_dphi);
  }
  if (!clip.half_q.empty()) {
    DynamicClip half = clip;
    half.q = clip.half_q;
    half.dq_dphi = clip.half_dq_dphi;
    half.half_q.clear();
    half.half_dq_dphi.clear();
    half = mirrored(mirror, half);
    reflected.half_q = half.q;
    reflected.half_dq_dphi = half.dq_dphi;
  }
  for (const Foot foot : {kLeft, kRight}) {
    const Foot other = foot == kLeft ? kRight : kLeft;
    reflected.contact_center[foot] = wrap_cycle(clip.contact_center[other] + 0.5);
    reflected.duty_factor[foot] = clip.duty_factor[other];
  }
  reflected.mean_velocity[kVy] = -clip.mean_velocity[kVy];
  reflected.mean_velocity[kOmega] = -clip.mean_velocity[kOmega];
  return reflected;
}

}  // namespace pmg
