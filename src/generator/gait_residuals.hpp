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

/// What the ground residuals take of a foot, in the heading frame H at the base's origin.
template <typename T>
struct FootOnGround {
  SoleContact<T> contact;
  T omega_z{};             ///< of the foot
  T toes_up{}, side_up{};  ///< z of the sole's x and y axes
  T inner_edge_y{};        ///< of the sole's corners, the one nearest to the other foot
};

/// Ground residuals of one phase sample of one scenario. Parameters: four knots of the left leg, then four of the
/// right, each kLegJoints deviations from stand. Called with ceres::Jet it differentiates itself, which
/// GroundCost (ground_cost.hpp) does faster: tests compare the two. The base has the attitude of hiking_base(). Its
/// velocity v, omega is the mean, by contact weight, of the velocities under which each stance foot stands still.
class GroundResiduals {
 public:
  GroundResiduals(const RobotLegs& legs, const GaitTask& task, const Scenario& scenario, double phase,
                  std::size_t sample, std::size_t knots, const Eigen::Vector3d& velocity_correction);

  template <typename T>
  bool operator()(const T* l0, const T* l1, const T* l2, const T* l3, const T* r0, const T* r1, const T* r2,
                  const T* r3, T* residual) const {
    const PerFoot<std::array<const T*, 4>> knots = {std::array<const T*, 4>{l0, l1, l2, l3},
                                                    std::array<const T*, 4>{r0, r1, r2, r3}};
    PerFoot<FootOnGround<T>> foot;
    for (const Foot f : {kLeft, kRight}) {
      LegVector<T> q;
      LegVector<T> dq;
      joints(f, knots[f], q, dq);
      const LegGeometry& leg = legs_.geometry[f];
      const FootMotion<T> motion = seen_from_heading(foot_motion<T>(leg, q, dq));
      foot[f] = {sole_contact<T>(leg, motion, kSoftness_m), motion.omega_BF.z(), motion.R_BF(2, 0), motion.R_BF(2, 1),
                 inner_edge(f, motion)};
    }
    ground(foot, residual);
    return true;
  }

  /// (knots) => (q, dq) of this foot: rad, rad/s.
  template <typename T>
  void joints(Foot f, const std::array<const T*, 4>& knots, LegVector<T>& q, LegVector<T>& dq) const {
    for (Eigen::Index i = 0; i < kLegJoints; ++i) {
      T value = T(0.0);
      T slope = T(0.0);
      for (std::size_t k = 0; k < 4; ++k) {
        value += basis_[f].value[k] * knots[k][i];
        slope += basis_[f].slope[k] * knots[k][i];
      }
      const double sign = sign_[f][i];
      q[i] = base_q_[f][i] + scenario_.gain * sign * value;
      dq[i] = (base_dq_dphi_[f][i] + scenario_.gain * sign * slope) / task_.period_s;
    }
  }

  /// d q_i / d knot k and d dq_i / d knot k of this foot.
  double dq_dknot(Foot f, std::size_t k, Eigen::Index i) const {
    return scenario_.gain * sign_[f][i] * basis_[f].value[k];
  }
  double drate_dknot(Foot f, std::size_t k, Eigen::Index i) const {
    return scenario_.gain * sign_[f][i] * basis_[f].slope[k] / task_.period_s;
  }

  const LegGeometry& leg(Foot f) const { return legs_.geometry[f]; }
  const Eigen::Matrix3d& R_HB() const { return R_HB_; }
  const Eigen::Vector3d& omega_HB() const { return omega_HB_; }

  static constexpr double kSoftness_m = 0.001;  ///< 0.2 degrees over the length of a foot

  /// (feet) => (kGroundResiduals residuals).
  template <typename T>
  void ground(const PerFoot<FootOnGround<T>>& foot, T* residual) const {
    const PerFoot<SoleContact<T>> contact = {foot[kLeft].contact, foot[kRight].contact};
    const GaitWeights& w = task_.weights;
    const double total = contact_[kLeft] + contact_[kRight];
    const double both = std::sqrt(contact_[kLeft] * contact_[kRight]);
    const PerFoot<double> share = {contact_[kLeft] / total, contact_[kRight] / total};

    // The base velocity with which each stance foot stands still.
    const T omega = -(share[kLeft] * foot[kLeft].omega_z + share[kRight] * foot[kRight].omega_z);
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
    residual[i++] = scale_ * w.slip_yaw * both * (foot[kLeft].omega_z - foot[kRight].omega_z);
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
      residual[i++] = scale_ * w.foot_flat * contact_[f] * foot[f].side_up;
      residual[i++] = scale_ * w.foot_flat * flat_[f] * foot[f].toes_up;
      residual[i++] = scale_ * w.sole * sole_[f] * beyond(foot[f].toes_up, task_.sole_free_rad);
      residual[i++] = scale_ * w.foot_flat * 0.1 * (1.0 - contact_[f]) * foot[f].side_up;
    }
    residual[i++] =
        scale_ * w.foot_gap * short_of(T(foot[kLeft].inner_edge_y - foot[kRight].inner_edge_y), task_.foot_gap_m);
    residual[i++] = scale_ * w.slip * 0.1 * both * (base[kLeft].z() - base[kRight].z());
  }

 private:
  static constexpr double kAboveGround_m = 0.001;  ///< height that a swinging foot shall keep

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

  /// y of the corner nearest to the other foot: the gap between both along the base's y axis, if it is positive, keeps
  /// the soles apart whatever their headings.
  template <typename T>
  T inner_edge(Foot f, const FootMotion<T>& foot) const {
    T inner = T(f == kLeft ? 1e9 : -1e9);
    for (const Eigen::Vector3d& corner : legs_.geometry[f].sole) {
      const T y = foot.p_BF.y() + (foot.R_BF * corner.cast<T>()).y();
      if (f == kLeft ? y < inner : y > inner) inner = y;
    }
    return inner;
  }

  /// (foot in the base frame) => (foot in the heading frame with the same origin).
  template <typename T>
  FootMotion<T> seen_from_heading(const FootMotion<T>& foot) const {
    const Matrix3<T> R = R_HB_.cast<T>();
    const Vector3<T> omega = omega_HB_.cast<T>();
    const Vector3<T> p = R * foot.p_BF;
    return {R * foot.R_BF, p, R * foot.v_BF + omega.cross(p), R * foot.omega_BF + omega};
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
