// Motors that turn one or two joints through cranks and rods: a four-bar, or the parallel ankle and waist of two
// motors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "drives/motor.hpp"

namespace pmg::drives {

/// One motor's crank and rod. The motor turns the crank about `axis` through `crank_centre`; the rod joins the crank's
/// end with the driven body. Everything at joint angle zero and motor angle zero, in the frame of the body that carries
/// the motors, with the joints' common centre as origin [m].
struct CrankAndRod {
  Eigen::Vector3d crank_centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  Eigen::Vector3d crank_end_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rod_end_m = Eigen::Vector3d::Zero();  ///< on the driven body
};

/// As many motors as joints, N = 1 or 2. With the rotation R(q) = R(axis_0, q_0) R(axis_1, q_1), the rod's end on the
/// body P = R(q) rod_end and the crank's end C(theta), each motor holds |C(theta) - P(q)| = rod length.
template <int N>
class RodLinkage {
 public:
  static_assert(N == 1 || N == 2);
  static constexpr std::size_t kN = N;
  using Angles = Eigen::Matrix<double, N, 1>;
  using Jacobian = Eigen::Matrix<double, N, N>;
  using Commands = std::array<MotorCommand, kN>;
  using Readings = std::array<MotorReading, kN>;

  /// The least sine of the angle between crank and rod, and the largest ratio of the Jacobian's singular values, that a
  /// linkage may have within the joints' ranges: closer to a singularity torques grow beyond any motor.
  static constexpr double kLeastSine = 0.2, kMostCondition = 10.0;

  /// Throws std::invalid_argument when the numbers make no linkage.
  RodLinkage(const std::array<Eigen::Vector3d, kN>& joint_axes, const std::array<CrankAndRod, kN>& motors);

  /// (q) => (theta) in closed form, on the branch that q = 0 has at theta = 0. Nullopt: the rod doesn't reach.
  std::optional<Angles> motor_angles(const Angles& q_rad) const noexcept;
  /// (theta) => (q), Newton's method from a guess near the solution. Nullopt: no convergence.
  std::optional<Angles> joint_angles(const Angles& theta_rad, const Angles& guess_rad) const noexcept;

  /// What the cranks' motors say, at the joints: dq = J^-1 dtheta, torque_q = J^T torque_theta; the rest is each
  /// motor's own. Nullopt: no joint angles belong to the cranks'.
  std::optional<Readings> to_joints(const Readings& motors, const Angles& guess_rad) const noexcept;

  /// J = d theta / d q at a pair of angles that belong together:
  ///   J_ij = ((C - P) . dP/dq_j) / ((C - P) . dC/dtheta_i).
  /// Then dtheta = J dq and torque_joint = J^T torque_motor.
  Jacobian jacobian(const Angles& theta_rad, const Angles& q_rad) const noexcept;

  /// The PD of joints, closed at the measured angles, as commands to the motors:
  ///   torque_motor = J^-T (kp (q_des - q) + kd (dq_des - dq) + tau),
  /// of which each motor's drive closes the part of its own angle, with the diagonal of J^-T K J^-1 as gain; the rest
  /// is feed-forward. At the measured angles the sum is exact, between two cycles to first order.
  Commands to_motors(const Commands& joints, const Angles& q_rad, const Angles& dq_rad_s,
                     const Angles& theta_rad) const noexcept;

  /// Throws std::invalid_argument when somewhere within the joints' ranges a rod doesn't reach or a singularity is
  /// closer than the bounds above. The text says where.
  void check_ranges(const Angles& lower_rad, const Angles& upper_rad) const;

  /// What a motor needs for the joints' ranges, speeds, torques and gains, over a grid of the ranges:
  ///   max |J| dq, max |J^-T| torque, max diagonal of J^-T K J^-1. For ranges that check_ranges() has taken.
  struct Needs {
    MotorLimits limits;
    MotorCommand gains;  ///< kp and kd
  };
  std::array<Needs, kN> needs(const std::array<MotorLimits, kN>& joints, const Commands& gains) const;

 private:
  /// Calls visit(q) for each point of a grid over the ranges.
  template <typename Visit>
  static void for_grid(const Angles& lower_rad, const Angles& upper_rad, Visit&& visit);

  struct Motor {
    CrankAndRod at_zero;
    Eigen::Vector3d arm_m;  // from the crank's centre to its end, across the axis, at theta = 0
    double rod2_m2 = 0.0;   // square of the rod's length
    double branch = 1.0;    // 1 or -1
    Eigen::Vector3d arm(double theta_rad) const noexcept;
  };
  Eigen::Vector3d rod_end(const Motor& motor, const Angles& q_rad) const noexcept;
  Eigen::Vector3d rod_end_rate(const Motor& motor, const Angles& q_rad, int joint) const noexcept;
  double residual(const Motor& motor, double theta_rad, const Angles& q_rad) const noexcept;
  double sine(const Motor& motor, double theta_rad, const Angles& q_rad) const noexcept;

  std::array<Eigen::Vector3d, kN> axes_;
  std::array<Motor, kN> motors_;
};

extern template class RodLinkage<1>;
extern template class RodLinkage<2>;

}  // namespace pmg::drives
