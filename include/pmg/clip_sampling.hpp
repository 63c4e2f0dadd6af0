// A dynamic clip as a curve over phase: periodic cubic Hermite interpolation of q and dq/dphi.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pmg/clip.hpp"
#include "pmg/types.hpp"

namespace pmg {

/// q(phi): the periodic cubic Hermite curve through a clip's samples and slopes. q and dq/dphi are continuous.
class ClipCurve {
 public:
  ClipCurve() = default;

  /// Copies the samples; allocates. The clip must have at least one sample and as many slopes.
  explicit ClipCurve(const DynamicClip& clip)
      : samples_(static_cast<double>(clip.q.size())),
        knots_(clip.q.front().size(), 2 * static_cast<Eigen::Index>(clip.q.size() + 1)) {
    for (std::size_t k = 0; k <= clip.q.size(); ++k) {  // the last knot repeats the first sample: no segment wraps
      const auto column = 2 * static_cast<Eigen::Index>(k);
      knots_.col(column) = clip.q[k % clip.q.size()];
      knots_.col(column + 1) = clip.dq_dphi[k % clip.q.size()];
    }
  }

  /// q [rad] and dq/dphi [rad per cycle] at a phase in [0, 1).
  void sample(double phase, JointVector& q, JointVector& dq_dphi) const noexcept {
    const Segment s = segment(phase);
    const auto x = knots_.middleCols<4>(s.column);
    q.noalias() = x * s.value;
    dq_dphi.noalias() = x * s.slope;
  }

  /// The neighbouring knots of a phase and their weights for q and for dq/dphi; the same for all curves with as many
  /// samples.
  struct Segment {
    Eigen::Index column = 0;
    Eigen::Vector4d value = Eigen::Vector4d::Zero();
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
  };

  /// phase in [0, 1).
  Segment segment(double phase) const noexcept {
    const double x = phase * samples_;
    const double k = std::min(std::floor(x), samples_ - 1.0);  // phase just below 1 may round up to the end
    return {2 * static_cast<Eigen::Index>(k), value_weights(x - k), slope_weights(x - k)};
  }

  /// Gains and Hermite weights are multiplied first, so each sum costs four multiply-adds of a joint vector. q and dq
  /// must be different vectors.
  ///   q += g q(phi),  dq += g dq/dphi dphi/dt + dg/dt q(phi).
  void add_blended(const Segment& s, double phase_rate_per_s, double gain, double gain_rate_per_s, JointVector& q,
                   JointVector& dq) const noexcept {
    const Eigen::Vector4d a = gain * s.value;
    const Eigen::Vector4d b = gain * phase_rate_per_s * s.slope + gain_rate_per_s * s.value;
    // One pass reads each knot once for both sums. Eigen's expressions need two passes and 1.5 times the time.
    const Eigen::Index joints = knots_.rows();
    const double* const x = knots_.data() + s.column * joints;
    double* __restrict const q_out = q.data();
    double* __restrict const dq_out = dq.data();
    for (Eigen::Index i = 0; i < joints; ++i) {
      const double x0 = x[i], x1 = x[i + joints], x2 = x[i + 2 * joints], x3 = x[i + 3 * joints];
      q_out[i] += a[0] * x0 + a[1] * x1 + a[2] * x2 + a[3] * x3;
      dq_out[i] += b[0] * x0 + b[1] * x1 + b[2] * x2 + b[3] * x3;
    }
  }

  /// Largest and smallest value of each joint over all phases [rad], exact for the interpolated curve.
  void extremes(JointVector& highest, JointVector& lowest) const {
    highest = knots_.col(0);
    lowest = knots_.col(0);
    for (Eigen::Index column = 0; column + 2 < knots_.cols(); column += 2) {
      for (Eigen::Index joint = 0; joint < knots_.rows(); ++joint) {
        widen_by_segment(knots_.row(joint).segment<4>(column).transpose(), highest[joint], lowest[joint]);
      }
    }
  }

  Eigen::Index joints() const noexcept { return knots_.rows(); }
  double samples() const noexcept { return samples_; }  ///< N

 private:
  // Cubic Hermite basis on a segment of length 1/N, t in [0, 1), for (q_k, q'_k, q_k+1, q'_k+1).
  Eigen::Vector4d value_weights(double t) const noexcept {
    const double h01 = t * t * (3.0 - 2.0 * t);
    return {1.0 - h01, t * (1.0 - t) * (1.0 - t) / samples_, h01, t * t * (t - 1.0) / samples_};
  }
  Eigen::Vector4d slope_weights(double t) const noexcept {
    const double dh01 = 6.0 * t * (1.0 - t) * samples_;
    return {-dh01, (1.0 - t) * (1.0 - 3.0 * t), dh01, t * (3.0 * t - 2.0)};
  }

  /// knots: q, q', q, q' of one joint at both ends. The extremes inside the segment are the roots of
  ///   dq/dt = a t^2 + b t + c = 0.
  void widen_by_segment(const Eigen::Vector4d& knots, double& highest, double& lowest) const {
    const double m0 = knots[1] / samples_, m1 = knots[3] / samples_, rise = knots[2] - knots[0];
    const double a = 3.0 * (m0 + m1 - 2.0 * rise), b = 2.0 * (3.0 * rise - 2.0 * m0 - m1), c = m0;
    const auto widen_at = [&](double t) {
      if (!(t >= 0.0 && t <= 1.0)) return;  // false for NaN too, which the divisions below can give
      const double q = value_weights(t).dot(knots);
      highest = std::max(highest, q);
      lowest = std::min(lowest, q);
    };
    widen_at(0.0);
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return;
    const double half_sum = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));  // this form avoids cancellation
    widen_at(half_sum / a);
    widen_at(c / half_sum);
  }

  double samples_ = 0.0;   ///< N
  Eigen::MatrixXd knots_;  ///< joints x 2 (N + 1): q_0, q'_0, q_1, q'_1, ... q_0, q'_0
};

}  // namespace pmg
