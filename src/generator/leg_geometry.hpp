// Kinematics of a leg for any scalar type, because the optimiser differentiates automatically. (KDL, used elsewhere,
// has double only.)
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "generator/joint_roles.hpp"
#include "model/robot_model.hpp"

namespace pmg::generator {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
/// Joint angles or their derivatives of one leg, by LegRole.
template <typename T>
using LegVector = Eigen::Matrix<T, kLegJoints, 1>;

/// One leg of the URDF: fixed transforms between revolute joints, from the base down.
struct LegGeometry {
  struct Segment {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< joint frame in the previous joint's frame at angle zero
    Eigen::Vector3d p = Eigen::Vector3d::Zero();      ///< [m]
    Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< unit, in the joint frame
    std::size_t role = 0;                             ///< LegRole of this joint
  };
  std::array<Segment, kLegJoints> segments;
  /// Corners [m] in the last joint's frame: front-left, front-right, rear-left, rear-right.
  std::array<Eigen::Vector3d, 4> sole;
};

LegGeometry leg_geometry(const model::RobotModel& robot, const JointRoles& roles, Foot foot);

/// Foot relative to the base B: attitude, origin of the last joint's frame, and their rates.
template <typename T>
struct FootMotion {
  Matrix3<T> R_BF;
  Vector3<T> p_BF, v_BF, omega_BF;
};

/// (q, dq) => (foot). q [rad] and dq [rad per unit of time] by LegRole; rates are per the same unit of time.
template <typename T>
FootMotion<T> foot_motion(const LegGeometry& leg, const LegVector<T>& q, const LegVector<T>& dq) {
  using std::cos;
  using std::sin;
  FootMotion<T> foot{Matrix3<T>::Identity(), Vector3<T>::Zero(), Vector3<T>::Zero(), Vector3<T>::Zero()};
  for (const LegGeometry::Segment& segment : leg.segments) {
    const auto role = static_cast<Eigen::Index>(segment.role);
    const Vector3<T> arm = foot.R_BF * segment.p.cast<T>();
    foot.p_BF += arm;
    foot.v_BF += foot.omega_BF.cross(arm);
    foot.R_BF = foot.R_BF * segment.R.cast<T>();
    const Vector3<T> axis_B = foot.R_BF * segment.axis.cast<T>();
    foot.omega_BF += axis_B * dq[role];
    // Rodrigues: R = I + sin(q) K + (1 - cos(q)) K^2.
    const Eigen::Matrix3d K{{0.0, -segment.axis.z(), segment.axis.y()},
                            {segment.axis.z(), 0.0, -segment.axis.x()},
                            {-segment.axis.y(), segment.axis.x(), 0.0}};
    const Eigen::Matrix3d K_squared = K * K;
    const T s = sin(q[role]);
    const T c1 = T(1.0) - cos(q[role]);
    Matrix3<T> turn = Matrix3<T>::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        turn(row, col) += s * K(row, col) + c1 * K_squared(row, col);
      }
    }
    foot.R_BF = foot.R_BF * turn;
  }
  return foot;
}

/// Contact of a foot with the ground: the lowest point of its sole, softened over the corners, so that it moves
/// continuously from an edge to the middle of a flat sole.
template <typename T>
struct SoleContact {
  Vector3<T> p;  ///< [m] in the base frame
  Vector3<T> v;  ///< velocity of the sole's material point there
};

/// Contact point p = sum w_c c / sum w_c over the corners c, w_c = exp((lowest z - c_z) / softness_m).
template <typename T>
SoleContact<T> sole_contact(const LegGeometry& leg, const FootMotion<T>& foot, double softness_m) {
  using std::exp;
  std::array<Vector3<T>, 4> corner;
  T lowest = T(1e9);
  for (std::size_t i = 0; i < 4; ++i) {
    corner[i] = foot.R_BF * leg.sole[i].cast<T>() + foot.p_BF;
    if (corner[i].z() < lowest) {
      lowest = corner[i].z();
    }
  }
  Vector3<T> p = Vector3<T>::Zero();
  T total = T(0.0);
  for (const Vector3<T>& c : corner) {
    const T weight = exp((lowest - c.z()) / softness_m);
    p += weight * c;
    total += weight;
  }
  p /= total;
  return {p, foot.v_BF + foot.omega_BF.cross(Vector3<T>(p - foot.p_BF))};
}

}  // namespace pmg::generator
