// The commands that keep every joint away from its limits at every phase; computed when the library is loaded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "pmg/blending.hpp"
#include "pmg/clip_sampling.hpp"
#include "pmg/half_gain.hpp"
#include "pmg/types.hpp"

namespace pmg {

/// The set of gains g and posture offsets q_s with
///   q_lower + margin <= q_stand + q_s + sum g_i (q_i(phi_i) - q_stand) <= q_upper - margin   for all joints and phi_i.
/// Each clip counts with its own worst phase: exact for one corner alone, conservative for mixtures, linear in the
/// gains. Where a clip says how it looks at half gain, all directions count at the same phase instead.
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

  /// For libraries with half-gain clips, each direction after its add(): the clip at the phases i / kPhases.
  void add_phases(std::size_t direction, const DynamicClip& clip, const JointVector& q_stand) {
    phasewise_ = true;
    const auto tabled = [](const DynamicClip& of, const JointVector& less, Eigen::MatrixXd& table) {
      const ClipCurve curve(of);
      JointVector q(less.size()), dq_dphi(less.size());
      table.resize(less.size(), kPhases);
      for (int i = 0; i < kPhases; ++i) {
        curve.sample(static_cast<double>(i) / kPhases, q, dq_dphi);
        table.col(i) = q - less;
      }
    };
    tabled(clip, q_stand, deviation_[direction]);
    if (has_half_gain(clip)) tabled(bend_of(clip, q_stand), JointVector::Zero(q_stand.size()), bend_[direction]);
  }

  bool contains_posture(const JointVector& q_s) const noexcept {
    return (q_s - room_up_).cwiseMax(-q_s - room_down_).maxCoeff() <= 0.0;
  }

  /// (gains, q_s) => (s): the largest s in [0, 1] for which s * gain is admissible on top of an admissible q_s. Gains
  /// from index `size` on are 0.
  double velocity_scale(const PerCorner<double>& gain, const JointVector& q_s,
                        std::size_t size = kCorners) const noexcept {
    if (phasewise_) return phasewise_velocity_scale(gain, q_s, size);
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
  /// The largest value between two of these phases is higher than theirs by 1 / 8 (2 pi n / kPhases)^2 of the amplitude
  /// of a clip's harmonic n: 3 mrad of half a radian twice a cycle, well within the margin.
  static constexpr int kPhases = 50;

  /// As velocity_scale. Clips that bend with their gain count at the same phase: their half-gain clips are large and
  /// opposite, so worst phases of each would forbid most mixtures. s is bisected as a posture's.
  double phasewise_velocity_scale(const PerCorner<double>& gain, const JointVector& q_s,
                                  std::size_t size) const noexcept {
    const auto contains = [&](double scale) {
      JointVector room_up = room_up_ - q_s;
      JointVector room_down = room_down_ + q_s;
      for (std::size_t d = kDirections; d < size; ++d) {
        if (gain[d] == 0.0) continue;
        room_up -= scale * gain[d] * up_[d];
        room_down -= scale * gain[d] * down_[d];
      }
      JointVector q(q_s.size());
      for (int i = 0; i < kPhases; ++i) {
        q.setZero();
        for (std::size_t d = 0; d < kDirections; ++d) {
          const double g = scale * gain[d];
          if (g == 0.0) continue;
          q += g * deviation_[d].col(i);
          if (bend_[d].cols() > 0) q += bend_gain(g) * bend_[d].col(i);
        }
        if ((q - room_up).cwiseMax(-q - room_down).maxCoeff() > 0.0) return false;
      }
      return true;
    };
    if (contains(1.0)) return 1.0;
    double inside = 0.0, outside = 1.0;
    for (int i = 0; i < 30; ++i) {  // 2^-30 = 1e-9 of the gains, as for postures
      const double middle = 0.5 * (inside + outside);
      (contains(middle) ? inside : outside) = middle;
    }
    return inside;
  }

  /// The largest s in [0, 1] with s * excursion <= room, where the excursion exceeds the room by `beyond`.
  static double allowed(double beyond, double room) noexcept {
    return beyond > 0.0 ? std::max(room, 0.0) / (room + beyond) : 1.0;
  }

  JointVector room_up_;          ///< q_upper - margin - q_stand [rad]
  JointVector room_down_;        ///< q_stand - q_lower - margin [rad]
  PerCorner<JointVector> up_;    ///< largest q_i(phi) - q_stand over phi [rad]
  PerCorner<JointVector> down_;  ///< largest q_stand - q_i(phi) over phi [rad]

  bool phasewise_ = false;
  PerDirection<Eigen::MatrixXd> deviation_;  ///< q_i - q_stand at the phases i / kPhases, one a column [rad]
  PerDirection<Eigen::MatrixXd> bend_;       ///< b of half_gain.hpp at the same phases; empty where a clip has none
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
