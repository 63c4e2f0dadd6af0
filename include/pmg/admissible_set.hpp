// The commands that keep every joint away from its limits at every phase; computed when the library is loaded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
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

  /// Some clip says how it looks at half gain. Then a joint may leave its room in the middle of the gains alone, and
  /// velocity_scale jumps between that middle and the whole.
  bool bends() const noexcept { return phasewise_; }

  bool contains_posture(const JointVector& q_s) const noexcept {
    return (q_s - room_up_).cwiseMax(-q_s - room_down_).maxCoeff() <= 0.0;
  }

  /// (gains, q_s) => (s): the largest s in [0, 1] for which s * gain is admissible on top of an admissible q_s. Gains
  /// from index `size` on are 0. Continuous in both, but for libraries that bend (bends()).
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
  /// opposite, so worst phases of each would forbid most mixtures. Along s a joint deviates by a s - c s^2, so it may
  /// leave its room and come back: where the whole of the gains isn't admissible, s is where a joint leaves first.
  double phasewise_velocity_scale(const PerCorner<double>& gain, const JointVector& q_s,
                                  std::size_t size) const noexcept {
    JointVector room_up = room_up_ - q_s;
    JointVector room_down = room_down_ + q_s;
    JointVector corners_up = JointVector::Zero(q_s.size()), corners_down = corners_up, a(q_s.size()), c(q_s.size());
    for (std::size_t d = kDirections; d < size; ++d) {
      if (gain[d] == 0.0) continue;
      corners_up += gain[d] * up_[d];
      corners_down += gain[d] * down_[d];
    }
    double first = 1.0;
    bool contained = true;
    for (int phase = 0; phase < kPhases; ++phase) {
      a.setZero();
      c.setZero();
      for (std::size_t d = 0; d < kDirections; ++d) {
        if (gain[d] == 0.0) continue;
        a += gain[d] * deviation_[d].col(phase);
        if (bend_[d].cols() == 0) continue;
        a += 4.0 * gain[d] * bend_[d].col(phase);
        c += 4.0 * gain[d] * gain[d] * bend_[d].col(phase);
      }
      for (Eigen::Index i = 0; i < q_s.size(); ++i) {
        contained =
            contained && a[i] + corners_up[i] - c[i] <= room_up[i] && corners_down[i] - a[i] + c[i] <= room_down[i];
        first = std::min(first, leaves(a[i] + corners_up[i], c[i], room_up[i]));
        first = std::min(first, leaves(corners_down[i] - a[i], -c[i], room_down[i]));
      }
    }
    return contained ? 1.0 : first;
  }

  /// The least s in [0, 1] beyond which a s - c s^2 <= room fails; 1 where it never does.
  static double leaves(double a, double c, double room) noexcept {
    room = std::max(room, 0.0);
    if (a <= room && a - c <= room && c <= 0.5 * a) return 1.0;
    const double discriminant = a * a - 4.0 * c * room;
    if (discriminant < 0.0 || (a <= 0.0 && c >= 0.0)) return 1.0;
    const double root = std::sqrt(discriminant);
    return std::min(1.0, a > 0.0 ? 2.0 * room / (a + root) : (a - root) / (2.0 * c));
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
