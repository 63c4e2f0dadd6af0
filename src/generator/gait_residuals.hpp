// Residuals of the clip optimisation: contact with the ground, posture, smoothness.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>

#include "generator/gait_optimization.hpp"
#include "generator/periodic_spline.hpp"

namespace pmg::generator {

inline constexpr int kGroundResiduals = 24;

/// Ground residuals of one phase sample of one scenario. Parameters: four knots of the left leg, then four of the
/// right, each kLegJoints deviations from stand. The base has the attitude of hiking_base(). Its velocity v, omega is
/// the mean, by contact weight, of the velocities under which each stance foot stands still.
class GroundResiduals {
 public:
  GroundResiduals(const RobotLegs& legs, const GaitTask& task, const Scenario& scenario, double phase,
                  std::size_t sample, std::size_t knots, const Eigen::Vector3d& velocity_correction);

  template <typename T>
  bool operator()(const T* l0, const T* l1, const T* l2, const T* l3, const T* r0, const T* r1, const T* r2,
                  const T* r3, T* residual) const {
    const PerFoot<std::array<const T*, 4>> knots = {std::array<const T*, 4>{l0, l1, l2, l3},
                                                    std::array<const T*, 4>{r0, r1, r2, r3}};
    PerFoot<FootMotion<T>> foot;
    PerFoot<SoleContact<T>> contact;
    for (const Foot f : {kLeft, kRight}) {
      LegVector<T> q;
      LegVector<T> dq;
      for (Eigen::Index i = 0; i < kLegJoints; ++i) {
        T value = T(0.0);
        T slope = T(0.0);
        for (std::size_t k = 0; k < 4; ++k) {
          value += basis_[f].value[k] * knots[f][k][i];
          slope += basis_[f].slope[k] * knots[f][k][i];
        }
        const double sign = sign_[f][i];
        q[i] = base_q_[f][i] + scenario_.gain * sign * value;
        dq[i] = (base_dq_dphi_[f][i] + scenario_.gain * sign * slope) / task_.period_s;
      }
      foot[f] = seen_from_heading(foot_motion<T>(legs_.geometry[f], q, dq));
      contact[f] = sole_contact<T>(legs_.geometry[f], foot[f], kSoftness_m);
    }
    ground(foot, contact, residual);
    return true;
  }

 private:
  /// (foot in the base frame) => (foot in the heading frame with the same origin).
  template <typename T>
  FootMotion<T> seen_from_heading(const FootMotion<T>& foot) const {
    const Matrix3<T> R = R_HB_.cast<T>();
    const Vector3<T> omega = omega_HB_.cast<T>();
    const Vector3<T> p = R * foot.p_BF;
    return {R * foot.R_BF, p, R * foot.v_BF + omega.cross(p), R * foot.omega_BF + omega};
  }

  static constexpr double kSoftness_m = 0.001;     ///< 0.2 degrees over the length of a foot
  static constexpr double kAboveGround_m = 0.001;  ///< height that a swinging foot shall keep

  template <typename T>
  void ground(const PerFoot<FootMotion<T>>& foot, const PerFoot<SoleContact<T>>& contact, T* residual) const {
    const GaitWeights& w = task_.weights;
    const double total = contact_[kLeft] + contact_[kRight];
    const double both = std::sqrt(contact_[kLeft] * contact_[kRight]);
    const PerFoot<double> share = {contact_[kLeft] / total, contact_[kRight] / total};

    // The base velocity with which each stance foot stands still.
    const T omega = -(share[kLeft] * foot[kLeft].omega_BF.z() + share[kRight] * foot[kRight].omega_BF.z());
    PerFoot<Vector3<T>> base;
    for (const Foot f : {kLeft, kRight}) {
      base[f] = Vector3<T>(-contact[f].v.x() + omega * contact[f].p.y(), -contact[f].v.y() - omega * contact[f].p.x(),
                           -contact[f].v.z());
    }
    const Vector3<T> v = share[kLeft] * base[kLeft] + share[kRight] * base[kRight];
    const T ground_z = share[kLeft] * contact[kLeft].p.z() + share[kRight] * contact[kRight].p.z();

    int i = 0;
    residual[i++] = scale_ * w.slip * both * (base[kLeft].x() - base[kRight].x());
    residual[i++] = scale_ * w.slip * both * (base[kLeft].y() - base[kRight].y());
    residual[i++] = scale_ * w.slip_yaw * both * (foot[kLeft].omega_BF.z() - foot[kRight].omega_BF.z());
    const T step = contact[kLeft].p.z() - contact[kRight].p.z();
    residual[i++] = scale_ * w.step_height_inside * near_both_ * step;
    residual[i++] = scale_ * w.step_height * near_both_ * beyond(step, w.step_height_free_m);
    residual[i++] = scale_ * w.velocity * (v.x() - velocity_.x());
    residual[i++] = scale_ * w.velocity * (v.y() - velocity_.y());
    residual[i++] = scale_ * w.velocity_up * v.z();
    residual[i++] = scale_ * w.velocity_yaw * (omega - velocity_.z());
    residual[i++] = scale_ * w.height * (-ground_z - height_m_);
    for (const Foot f : {kLeft, kRight}) {
      // In swing the other foot determines the ground.
      const T above = contact[f].p.z() - contact[f == kLeft ? kRight : kLeft].p.z();
      residual[i++] = scale_ * w.clearance * short_of(above, clearance_m_[f]);
      residual[i++] = scale_ * w.above_ground * lifted_[f] * short_of(above, kAboveGround_m);
      residual[i++] = scale_ * w.foot_flat * contact_[f] * foot[f].R_BF(2, 1);
      residual[i++] = scale_ * w.foot_flat * flat_[f] * foot[f].R_BF(2, 0);
      residual[i++] = scale_ * w.sole * sole_[f] * beyond(foot[f].R_BF(2, 0), task_.sole_free_rad);
      residual[i++] = scale_ * w.foot_flat * 0.1 * (1.0 - contact_[f]) * foot[f].R_BF(2, 1);
    }
    residual[i++] = scale_ * w.foot_gap * short_of(gap(foot), task_.foot_gap_m);
    residual[i++] = scale_ * w.slip * 0.1 * both * (base[kLeft].z() - base[kRight].z());
  }

  /// The part of a value beyond +-free.
  template <typename T>
  static T beyond(const T& value, double free) {
    if (value > free) {
      return value - free;
    }
    return value < -free ? T(value + free) : T(0.0);
  }

  /// max(need - have, 0), rounded over a millimetre so that its slope is continuous.
  template <typename T>
  static T short_of(const T& have, double need_m) {
    if (need_m <= 0.0) {
      return T(0.0);
    }
    const T lack = need_m - have;
    constexpr double kRound_m = 0.001;
    if (lack <= 0.0) {
      return T(0.0);
    }
    if (lack < kRound_m) {
      return lack * lack / (2.0 * kRound_m);
    }
    return lack - kRound_m / 2.0;
  }

  /// Gap between the soles along the base's y axis. If it is positive they don't touch, whatever their headings.
  template <typename T>
  T gap(const PerFoot<FootMotion<T>>& foot) const {
    T left = T(1e9);
    T right = T(-1e9);
    for (std::size_t c = 0; c < 4; ++c) {
      const T yl = foot[kLeft].p_BF.y() + (foot[kLeft].R_BF * legs_.geometry[kLeft].sole[c].cast<T>()).y();
      const T yr = foot[kRight].p_BF.y() + (foot[kRight].R_BF * legs_.geometry[kRight].sole[c].cast<T>()).y();
      left = yl < left ? yl : left;
      right = yr > right ? yr : right;
    }
    return left - right;
  }

  const RobotLegs& legs_;
  const GaitTask& task_;
  const Scenario& scenario_;
  PerFoot<SplineBasis> basis_;
  PerFoot<LegVector<double>> sign_, base_q_, base_dq_dphi_;
  PerFoot<double> contact_{}, clearance_m_{}, flat_{}, sole_{};  ///< sole_: 1 where the sole shall lie flat
  PerFoot<double> lifted_{};  ///< 0 in stance, 1 in swing as soon as the foot no longer carries the height
  Eigen::Matrix3d R_HB_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d omega_HB_ = Eigen::Vector3d::Zero();
  double near_both_ = 0.0;
  double height_m_ = 0.0;
  double scale_ = 1.0;
  Eigen::Vector3d velocity_;
};

/// weight_i (q - reference - bias), and the joint limits less their margin: one sample of one leg, linear in four knots
/// and in the bias of the leg's mean posture.
class PostureResiduals {
 public:
  PostureResiduals(const RobotLegs& legs, const GaitTask& task, Foot foot, std::size_t sample, std::size_t knots);

  template <typename T>
  bool operator()(const T* k0, const T* k1, const T* k2, const T* k3, const T* bias, T* residual) const {
    const std::array<const T*, 4> knots = {k0, k1, k2, k3};
    for (Eigen::Index i = 0; i < kLegJoints; ++i) {
      T q = T(stand_[i]);
      for (std::size_t k = 0; k < 4; ++k) {
        q += basis_.value[k] * knots[k][i];
      }
      residual[i] = reference_weight_[i] * (q - reference_[i] - bias[i]);
      T beyond = T(0.0);
      if (q < lower_[i]) {
        beyond = lower_[i] - q;
      } else if (q > upper_[i]) {
        beyond = q - upper_[i];
      }
      residual[kLegJoints + i] = limit_weight_ * beyond;
    }
    return true;
  }

 private:
  static constexpr double kLimitMargin_rad = 0.07;  ///< 4 degrees: the generator keeps 2 degrees after adding a posture
  SplineBasis basis_;
  LegVector<double> stand_, reference_, reference_weight_, lower_, upper_;
  double limit_weight_;
};

/// weight bias: keeps the mean posture near the reference's.
struct BiasResiduals {
  LegVector<double> weight;

  template <typename T>
  bool operator()(const T* bias, T* residual) const {
    for (Eigen::Index i = 0; i < kLegJoints; ++i) {
      residual[i] = weight[i] * bias[i];
    }
    return true;
  }
};

/// weight (before - 2 here + after): second difference of the knots of one leg.
struct SmoothResiduals {
  double weight;

  template <typename T>
  bool operator()(const T* before, const T* here, const T* after, T* residual) const {
    for (int i = 0; i < kLegJoints; ++i) {
      residual[i] = weight * (before[i] - 2.0 * here[i] + after[i]);
    }
    return true;
  }
};

}  // namespace pmg::generator
