// The clips at the corners of the command box (Blend::kCorners): the library's own, their mirror images, and
// superpositions for the rest.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "pmg/blending.hpp"
#include "pmg/clip.hpp"
#include "pmg/clip_sampling.hpp"
#include "pmg/library_check.hpp"
#include "pmg/mirror.hpp"
#include "pmg/phase.hpp"

namespace pmg {

/// Superposition of clips that lifts the feet only once. Let d_i(phi) = q_i(phi) - q_stand. Opposite directions have
/// the lift of the feet in common; the rest of their motion has opposite signs. So M(phi), the mean of d_i over
/// opposite directions, is stepping on the spot. Then
///   pair:    d_ab = d_a + d_b - M,
///   triple:  d_abc = mean over its three pairs of (d_pair + d_single) - M.
class Superposition {
 public:
  /// clips: the checked directions, and the corners known so far. Copies; allocates.
  Superposition(const PerCorner<std::optional<DynamicClip>>& clips, const JointVector& q_stand)
      : clips_(clips), q_stand_(q_stand) {
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      if (clips_[direction_of(channel, false)] && clips_[direction_of(channel, true)]) ++both_ways_;
    }
    for (std::size_t c = 0; c < kCorners; ++c) {
      if (clips_[c]) curve_[c] = ClipCurve(*clips_[c]);
    }
  }

  /// The clip at a corner; the corner's directions, and the pairs in it, must have clips. T, mu and r are the mean over
  /// the directions, the mean velocity is their sum.
  DynamicClip at(const Corner& corner) const {
    const std::size_t samples = clips_[parts(corner, 1).front()]->q.size();
    DynamicClip clip;
    for (std::size_t k = 0; k < samples; ++k) {
      const double phase = static_cast<double>(k) / static_cast<double>(samples);
      JointVector q = JointVector::Zero(q_stand_.size()), dq_dphi = q;
      add_deviations(corner, phase, q, dq_dphi);
      clip.q.push_back(q + q_stand_);
      clip.dq_dphi.push_back(dq_dphi);
    }
    PerCorner<double> equal{};
    const auto directions = parts(corner, 1);
    for (const std::size_t d : directions) equal[d] = 1.0 / static_cast<double>(directions.size());
    const GaitTiming timing = GaitTimings(clips_).average(equal);
    clip.period_s = timing.period_s;
    clip.contact_center = timing.contact_center;
    clip.duty_factor = timing.duty_factor;
    for (const std::size_t d : directions) {
      for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
        clip.mean_velocity[channel] += clips_[d]->mean_velocity[channel];
      }
    }
    return clip;
  }

 private:
  /// Indices of the corners that use this number of the corner's channels, with its signs.
  static std::vector<std::size_t> parts(const Corner& corner, int channels) {
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < kCorners; ++c) {
      int used = 0;
      bool within = true;
      for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
        const int sign = kCornerTable[c].sign[channel];
        used += sign != 0 ? 1 : 0;
        within = within && (sign == 0 || sign == corner.sign[channel]);
      }
      if (within && used == channels) found.push_back(c);
    }
    return found;
  }

  /// Adds factor * d_c(phi) and its slope.
  void add(std::size_t c, double factor, double phase, JointVector& q, JointVector& dq_dphi) const {
    JointVector sample(q.size()), slope(q.size());
    curve_[c].sample(phase, sample, slope);
    q += factor * (sample - q_stand_);
    dq_dphi += factor * slope;
  }

  /// Adds factor * M(phi).
  void add_lift(double factor, double phase, JointVector& q, JointVector& dq_dphi) const {
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      const std::size_t forward = direction_of(channel, false), back = direction_of(channel, true);
      if (!clips_[forward] || !clips_[back]) continue;
      for (const std::size_t d : {forward, back}) add(d, 0.5 * factor / both_ways_, phase, q, dq_dphi);
    }
  }

  /// Adds d(phi) of the corner: the mean over its channels of d without the channel plus d of the channel alone, less
  /// M.
  void add_deviations(const Corner& corner, double phase, JointVector& q, JointVector& dq_dphi) const {
    const auto directions = parts(corner, 1);
    const auto used = static_cast<double>(directions.size());
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      if (corner.sign[channel] == 0) continue;
      Corner rest = corner;
      rest.sign[channel] = 0;
      add(corner_of(rest), 1.0 / used, phase, q, dq_dphi);
      add(direction_of(channel, corner.sign[channel] < 0), 1.0 / used, phase, q, dq_dphi);
    }
    add_lift(-1.0, phase, q, dq_dphi);
  }

  PerCorner<std::optional<DynamicClip>> clips_;
  PerCorner<ClipCurve> curve_;
  JointVector q_stand_;
  double both_ways_ = 0.0;  ///< channels that have both directions
};

/// Fills every corner whose directions all have clips: with the library's clip, else with a mirror image of one, else
/// with the superposition. Throws std::invalid_argument as the checks of library_check.hpp do.
inline void add_corner_clips(const ClipLibrary& library, PerCorner<std::optional<DynamicClip>>& clips) {
  for (const CornerClip& given : library.corners) {
    const std::size_t c = corner_of({given.sign});
    check::dynamic_clip(given.clip, library.q_stand.size(), check::corner_name(c));
    clips[c] = given.clip;
  }
  for (const CornerClip& given : library.corners) {
    auto& other = clips[corner_of({{given.sign[kVx], -given.sign[kVy], -given.sign[kOmega]}})];
    if (other) continue;
    check::mirror_map(library.mirror, library.q_stand.size());
    other = mirrored(library.mirror, given.clip);
  }
  check::contact_centers(clips);
  for (const int channels : {2, 3}) {  // triples need the pairs
    std::optional<Superposition> superposition;
    for (std::size_t c = kDirections; c < kCorners; ++c) {
      int used = 0;
      bool walkable = true;
      for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
        const int sign = kCornerTable[c].sign[channel];
        used += sign != 0 ? 1 : 0;
        walkable = walkable && (sign == 0 || clips[direction_of(channel, sign < 0)]);
      }
      if (clips[c] || !walkable || used != channels) continue;
      if (!superposition) superposition.emplace(clips, library.q_stand);
      clips[c] = superposition->at(kCornerTable[c]);
    }
  }
}

}  // namespace pmg
