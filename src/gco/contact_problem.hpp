// The least-squares problem of the ground-aware command optimisation (paper III-A.3, eq. 13 to 19) for TinySolver and
// ceres::Solver.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "model/leg_kinematics.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"
#include "pmg/types.hpp"

namespace pmg::gco {

/// The unknowns: v' [m/s] in H, omega_z' [rad/s] (z component of the base's angular velocity), h' [m] (deviation from
/// stand); with roll and pitch optimised also pitch' and roll' of the torso [rad]. The paper's deltas (eq. 16 to 18)
/// are these minus the command.
enum Unknown { kXVx = 0, kXVy, kXVz, kXOmega, kXHeight, kXPitch, kXRoll, kMaxUnknowns };

/// One foot relative to a base that stands still at the commanded pitch and roll.
struct FootTerms {
  Eigen::Vector3d lever_H = Eigen::Vector3d::Zero();     ///< base origin to contact point, R_HB p_f [m]
  Eigen::Vector3d velocity_H = Eigen::Vector3d::Zero();  ///< of the sole at the contact point, R_HB (J_f dq) [m/s]
  Eigen::Vector3d omega_H = Eigen::Vector3d::Zero();     ///< angular velocity of the foot [rad/s]
  double lowest_below_contact_m = 0.0;                   ///< smoothed minus true lowest point, at least 0
  double weight = 0.0;                                   ///< contact weight w_f
  double sqrt_weight = 0.0;
};

/// The data of the residuals in one tick.
struct ContactTerms {
  PerFoot<FootTerms> foot;
  Eigen::Vector3d omega_HB_H =
      Eigen::Vector3d::Zero();     ///< of the base from the commanded pitch and roll rates, z = 0 [rad/s]
  PerFoot<double> height_share{};  ///< see height_shares()
  double sqrt_height_weight = 0.0;
  double sqrt_level_weight = 0.0;          ///< of the feet's height difference; only roll and pitch can change it
  double standing_height_m = 0.0;          ///< h of u = 0: base origin above the soles
  double pitch_rad = 0.0, roll_rad = 0.0;  ///< commanded
  Eigen::Vector2d torso_heading_H = Eigen::Vector2d::UnitX();  ///< (cos, sin) of the torso's yaw in H
  std::array<double, kMaxUnknowns> prior{};                    ///< value to which the prior pulls each unknown
  std::array<double, kMaxUnknowns> prior_weight{};  ///< on the residual, relative to the contact residuals' 1
};

/// Motion of a foot for given unknowns (paper eq. 13 and 14).
template <typename T>
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): foot_motion() sets all of it, within the loop
struct FootMotion {
  Eigen::Matrix<T, 3, 1> lever_H;     ///< base origin to contact point [m]
  Eigen::Matrix<T, 3, 1> velocity_H;  ///< v_f = v' + omega' x lever + leg velocity [m/s]
  T yaw_rate;                         ///< [rad/s]
};

/// kUnknowns is 5 or 7. Residuals (paper eq. 15):
///   sqrt(w_f) (v_f [m/s], yaw rate [rad/s]) for each foot f,
///   sqrt(min(1, w_left + w_right)) (height of the lowest sole point above the ground [m]),
///   prior_weight (x - prior),
///   with 7 unknowns also sqrt(w_left w_right) (height difference of the feet [m]).
///
/// With 7 unknowns the contact points, the height shares and the heading frame stay those of the commanded attitude.
/// Apart from the commanded rates, pitch' and roll' count as constant over the tick.
template <int kUnknowns>
struct ContactProblem {
  static_assert(kUnknowns == 5 || kUnknowns == 7);
  using Scalar = double;
  enum {
    NUM_PARAMETERS = kUnknowns,
    kHeightRow = 8,
    kPriorRow = 9,
    kLevelRow = kPriorRow + kUnknowns,
    NUM_RESIDUALS = kUnknowns == 5 ? kLevelRow : kLevelRow + 1
  };

  const ContactTerms& terms;

  template <typename T>
  FootMotion<T> foot_motion(Foot foot, const T* x) const {
    const FootTerms& leg = terms.foot[foot];
    using Vector = Eigen::Matrix<T, 3, 1>;
    FootMotion<T> motion;
    const Vector v(x[kXVx], x[kXVy], x[kXVz]);
    const Vector omega(T(terms.omega_HB_H.x()), T(terms.omega_HB_H.y()), x[kXOmega]);
    if constexpr (kUnknowns == 7) {
      const Eigen::Matrix<T, 3, 3> turn = attitude_change(x);
      motion.lever_H = turn * leg.lever_H.cast<T>();
      motion.velocity_H = v + omega.cross(motion.lever_H) + turn * leg.velocity_H.cast<T>();
      motion.yaw_rate = x[kXOmega] + turn.row(2).dot(leg.omega_H.cast<T>());
    } else {
      motion.lever_H = leg.lever_H.cast<T>();
      motion.velocity_H = v + omega.cross(motion.lever_H) + leg.velocity_H.cast<T>();
      motion.yaw_rate = x[kXOmega] + T(leg.omega_H.z());
    }
    return motion;
  }

  /// x: kUnknowns values, r: NUM_RESIDUALS values. A template, so that automatic derivatives can check the analytic
  /// ones.
  template <typename T>
  void residuals(const T* x, T* r) const {
    PerFoot<FootMotion<T>> motion;
    for (const Foot foot : {kLeft, kRight}) {
      motion[foot] = foot_motion(foot, x);
      const double weight = terms.foot[foot].sqrt_weight;
      T* row = r + 4 * foot;
      for (int axis = 0; axis < 3; ++axis) row[axis] = weight * motion[foot].velocity_H[axis];
      row[3] = weight * motion[foot].yaw_rate;
    }
    const T& left_m = motion[kLeft].lever_H.z();
    const T& right_m = motion[kRight].lever_H.z();
    r[kHeightRow] =
        terms.sqrt_height_weight * (terms.standing_height_m + x[kXHeight] + terms.height_share[kLeft] * left_m +
                                    terms.height_share[kRight] * right_m);
    for (std::size_t i = 0; i < kUnknowns; ++i) r[kPriorRow + i] = terms.prior_weight[i] * (x[i] - terms.prior[i]);
    if constexpr (kUnknowns == 7) r[kLevelRow] = terms.sqrt_level_weight * (left_m - right_m);
  }

  /// The interface of ceres::TinySolver. jacobian: NUM_RESIDUALS x kUnknowns, column-major, or null.
  bool operator()(const double* x, double* r, double* jacobian) const {
    residuals(x, r);
    if (jacobian != nullptr) fill_jacobian(x, jacobian);
    return true;
  }

 private:
  /// Rotation in H of everything attached to the base, when torso pitch and roll differ from the commanded ones.
  template <typename T>
  Eigen::Matrix<T, 3, 3> attitude_change(const T* x) const {
    using std::cos;
    using std::sin;
    const T pitch = x[kXPitch];
    const T d_roll = x[kXRoll] - terms.roll_rad;
    const T cp = cos(pitch), sp = sin(pitch), cr = cos(d_roll), sr = sin(d_roll), zero(0.0), one(1.0);
    Eigen::Matrix<T, 3, 3> R_pitch, R_roll;
    R_pitch << cp, zero, sp, zero, one, zero, -sp, zero, cp;
    R_roll << one, zero, zero, zero, cr, -sr, zero, sr, cr;
    const double cu = std::cos(terms.pitch_rad), su = std::sin(terms.pitch_rad);
    const double cy = terms.torso_heading_H.x(), sy = terms.torso_heading_H.y();
    const Eigen::Matrix3d R_HT_yaw{{cy, -sy, 0.0}, {sy, cy, 0.0}, {0.0, 0.0, 1.0}};
    const Eigen::Matrix3d R_pitch_back{{cu, 0.0, -su}, {0.0, 1.0, 0.0}, {su, 0.0, cu}};
    const Eigen::Matrix3d before = R_pitch_back * R_HT_yaw.transpose();
    return R_HT_yaw.cast<T>() * R_pitch * R_roll * before.template cast<T>();
  }

  void fill_jacobian(const double* x, double* jacobian) const;
};

/// (reference, feet, attitude) => (terms of one tick). prior_weight as in Options. held_height_m: target of the height
/// while no foot is in contact. feet and attitude must be those of the reference's q, dq and command.
ContactTerms contact_terms(const Reference& reference, const PerFoot<model::FootKinematics>& feet,
                           const model::BaseAttitude::Result& attitude, double standing_height_m, double prior_weight,
                           double held_height_m) noexcept;

}  // namespace pmg::gco
