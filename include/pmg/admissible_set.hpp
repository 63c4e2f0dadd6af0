// The commands that keep every joint away from its limits at every phase; computed when the library is loaded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "pmg/blending.hpp"
#include "pmg/clip_sampling.hpp"
#include "pmg/types.hpp"

namespace pmg {

/// The set of gains g and posture offsets q_s with
///   q_lower + margin <= q_stand + q_s + sum g_i (q_i(phi_i) - q_stand) <= q_upper - margin   for all joints and phi_i.
/// Each clip counts with its own worst phase: exact for one corner alone, conservative for mixtures, linear in the
/// gains.
class AdmissibleSet {
 public:
  AdmissibleSet() = default;

  /// q_stand must lie inside the limits by at least the margin.
  AdmissibleSet(const JointVector& q_stand, const JointVector& q_lower, const JointVector& q_upper, double margin_rad)
      : room_up_((q_upper - q_stand).array() - margin_rad), room_down_((q_stand - q_lower).array() - margin_rad) {
    for (std::size_t d = 0; d < kCorners; ++d) {
      up_[d].setZero(q_stand.size());
      down_[d].setZero(q_stand.size());
    }
  }

  /// corner: index in kCornerTable.
  void add(std::size_t corner, const ClipCurve& curve, const JointVector& q_stand) {
    curve.extremes(up_[corner], down_[corner]);
    up_[corner] -= q_stand;
    down_[corner] = q_stand - down_[corner];
  }

  bool contains_posture(const JointVector& q_s) const noexcept {
    return (q_s - room_up_).cwiseMax(-q_s - room_down_).maxCoeff() <= 0.0;
  }

  /// (gains, q_s) => (s): the largest s in [0, 1] for which s * gain is admissible on top of an admissible q_s. Gains
  /// from index `size` on are 0.
  double velocity_scale(const PerCorner<double>& gain, const JointVector& q_s,
                        std::size_t size = kCorners) const noexcept {
    JointVector above = q_s - room_up_;  // how far each joint is beyond its room [rad]
    JointVector below = -q_s - room_down_;
    for (std::size_t d = 0; d < size; ++d) {
      if (gain[d] == 0.0) continue;
      // Both sums in one pass over the joints: two of Eigen's take 1.5 times as long.
      const double g = gain[d];
      const double* const up = up_[d].data();
      const double* const down = down_[d].data();
      for (Eigen::Index i = 0; i < q_s.size(); ++i) {
        above[i] += g * up[i];
        below[i] += g * down[i];
      }
    }
    if (above.cwiseMax(below).maxCoeff() <= 0.0) return 1.0;
    double scale = 1.0;
    for (Eigen::Index i = 0; i < q_s.size(); ++i) {
      scale = std::min(scale, allowed(above[i], room_up_[i] - q_s[i]));
      scale = std::min(scale, allowed(below[i], room_down_[i] + q_s[i]));
    }
    return scale;
  }

 private:
  /// The largest s in [0, 1] with s * excursion <= room, where the excursion exceeds the room by `beyond`.
  static double allowed(double beyond, double room) noexcept {
    return beyond > 0.0 ? std::max(room, 0.0) / (room + beyond) : 1.0;
  }

  JointVector room_up_;          ///< q_upper - margin - q_stand [rad]
  JointVector room_down_;        ///< q_stand - q_lower - margin [rad]
  PerCorner<JointVector> up_;    ///< largest q_i(phi) - q_stand over phi [rad]
  PerCorner<JointVector> down_;  ///< largest q_stand - q_i(phi) over phi [rad]
};

/// (offset_at) => (s, q_s): the largest s in [0, 1] for which the posture command scaled by s is admissible, and its
/// offset q_s. Posture curves bend, so s is bisected. If joints move monotonically with the command, as in any sensible
/// squat, bend or lean, s is the true maximum and continuous in the command.
template <typename Offset>
double posture_scale(const AdmissibleSet& set, const Offset& offset_at, JointVector& q_s) noexcept {
  offset_at(1.0, q_s);
  if (set.contains_posture(q_s)) return 1.0;
  double inside = 0.0, outside = 1.0;
  for (int i = 0; i < 30; ++i) {  // 2^-30 = 1e-9 of the command: far below what dq_ref could show
    const double middle = 0.5 * (inside + outside);
    offset_at(middle, q_s);
    (set.contains_posture(q_s) ? inside : outside) = middle;
  }
  offset_at(inside, q_s);
  return inside;
}

}  // namespace pmg
