#include "drives/rod_linkage.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pmg::drives {

namespace {

constexpr int kIterations = 20;       // quadratic convergence needs 4 from a millimetre away
constexpr double kSolved_m2 = 1e-14;  // a rod of 0.2 m is met within 3e-14 m
constexpr int kGrid = 21;             // a range of 1.7 rad in steps of 5 degrees
constexpr double kShortest_m = 1e-3;

Eigen::Matrix3d turn(const Eigen::Vector3d& axis, double angle_rad) noexcept {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

}  // namespace

template <int N>
RodLinkage<N>::RodLinkage(const std::array<Eigen::Vector3d, kN>& joint_axes, const std::array<CrankAndRod, kN>& motors)
    : axes_(joint_axes) {
  for (Eigen::Vector3d& axis : axes_) axis.normalize();
  for (std::size_t i = 0; i < kN; ++i) {
    CrankAndRod motor = motors[i];
    motor.axis.normalize();
    const Eigen::Vector3d arm = motor.crank_end_m - motor.crank_centre_m;
    const Eigen::Vector3d rod = motor.rod_end_m - motor.crank_end_m;
    if (!(arm.norm() > kShortest_m) || !(rod.norm() > kShortest_m) ||
        !(std::abs(arm.dot(motor.axis)) < 1e-6 * arm.norm())) {
      throw std::invalid_argument("a crank or a rod has no length, or a crank isn't perpendicular to its motor's axis");
    }
    Motor made{.at_zero = motor, .arm_m = arm, .rod2_m2 = rod.squaredNorm(), .branch = 1.0};
    // theta = phi + branch acos(...), phi the direction of the rod's end: at zero, the crank lies on this side of it.
    const Eigen::Vector3d d = motor.rod_end_m - motor.crank_centre_m;
    made.branch = d.dot(motor.axis.cross(arm)) > 0.0 ? -1.0 : 1.0;
    motors_[i] = made;
  }
}

template <int N>
Eigen::Vector3d RodLinkage<N>::Motor::arm(double theta_rad) const noexcept {
  return std::cos(theta_rad) * arm_m + std::sin(theta_rad) * at_zero.axis.cross(arm_m);
}

template <int N>
Eigen::Vector3d RodLinkage<N>::rod_end(const Motor& motor, const Angles& q_rad) const noexcept {
  Eigen::Vector3d point = motor.at_zero.rod_end_m;
  for (int j = N - 1; j >= 0; --j) point = turn(axes_[static_cast<std::size_t>(j)], q_rad[j]) * point;
  return point;
}

template <int N>
Eigen::Vector3d RodLinkage<N>::rod_end_rate(const Motor& motor, const Angles& q_rad, int joint) const noexcept {
  Eigen::Vector3d point = motor.at_zero.rod_end_m;
  for (int j = N - 1; j >= 0; --j) {
    point = turn(axes_[static_cast<std::size_t>(j)], q_rad[j]) * point;
    if (j == joint) point = axes_[static_cast<std::size_t>(j)].cross(point);
  }
  return point;
}

template <int N>
double RodLinkage<N>::residual(const Motor& motor, double theta_rad, const Angles& q_rad) const noexcept {
  return (motor.at_zero.crank_centre_m + motor.arm(theta_rad) - rod_end(motor, q_rad)).squaredNorm() - motor.rod2_m2;
}

template <int N>
double RodLinkage<N>::sine(const Motor& motor, double theta_rad, const Angles& q_rad) const noexcept {
  const Eigen::Vector3d arm = motor.arm(theta_rad), rod = motor.at_zero.crank_centre_m + arm - rod_end(motor, q_rad);
  return rod.normalized().dot(motor.at_zero.axis.cross(arm).normalized());
}

// With d from the crank's centre to the rod's end: d . arm(theta) = (|arm|^2 + |d|^2 - rod^2) / 2, and the left side is
// A cos theta + B sin theta.
template <int N>
auto RodLinkage<N>::motor_angles(const Angles& q_rad) const noexcept -> std::optional<Angles> {
  Angles theta;
  for (int i = 0; i < N; ++i) {
    const Motor& motor = motors_[static_cast<std::size_t>(i)];
    const Eigen::Vector3d d = rod_end(motor, q_rad) - motor.at_zero.crank_centre_m;
    const double a = d.dot(motor.arm_m), b = d.dot(motor.at_zero.axis.cross(motor.arm_m));
    const double c = 0.5 * (motor.arm_m.squaredNorm() + d.squaredNorm() - motor.rod2_m2);
    const double reach = std::hypot(a, b);
    if (!(std::abs(c) <= reach)) return std::nullopt;
    theta[i] = std::remainder(std::atan2(b, a) + motor.branch * std::acos(c / reach), 2.0 * std::numbers::pi);
  }
  return theta;
}

template <int N>
auto RodLinkage<N>::joint_angles(const Angles& theta_rad, const Angles& guess_rad) const noexcept
    -> std::optional<Angles> {
  Angles q = guess_rad;
  for (int k = 0; k < kIterations; ++k) {
    Angles error;
    Jacobian slope;
    for (int i = 0; i < N; ++i) {
      const Motor& motor = motors_[static_cast<std::size_t>(i)];
      error[i] = residual(motor, theta_rad[i], q);
      const Eigen::Vector3d rod = motor.at_zero.crank_centre_m + motor.arm(theta_rad[i]) - rod_end(motor, q);
      for (int j = 0; j < N; ++j) slope(i, j) = -2.0 * rod.dot(rod_end_rate(motor, q, j));
    }
    if (error.cwiseAbs().maxCoeff() < kSolved_m2) return q;
    const double determinant = slope.determinant();
    if (!(std::abs(determinant) > 1e-18)) return std::nullopt;
    q -= slope.inverse() * error;
    if (!(q.cwiseAbs().maxCoeff() < std::numbers::pi)) return std::nullopt;
  }
  return std::nullopt;
}

template <int N>
auto RodLinkage<N>::to_joints(const Readings& motors, const Angles& guess_rad) const noexcept
    -> std::optional<Readings> {
  Angles theta, dtheta, torque;
  for (int i = 0; i < N; ++i) {
    const MotorReading& motor = motors[static_cast<std::size_t>(i)];
    theta[i] = motor.q_rad;
    dtheta[i] = motor.dq_rad_s;
    torque[i] = motor.torque_Nm;
  }
  const std::optional<Angles> q = joint_angles(theta, guess_rad);
  if (!q) return std::nullopt;
  const Jacobian J = jacobian(theta, *q);
  const Angles dq = J.inverse() * dtheta, joint_torque = J.transpose() * torque;
  Readings joints = motors;
  for (int i = 0; i < N; ++i) {
    MotorReading& joint = joints[static_cast<std::size_t>(i)];
    joint.q_rad = (*q)[i];
    joint.dq_rad_s = dq[i];
    joint.torque_Nm = joint_torque[i];
  }
  return joints;
}

template <int N>
auto RodLinkage<N>::jacobian(const Angles& theta_rad, const Angles& q_rad) const noexcept -> Jacobian {
  Jacobian J;
  for (int i = 0; i < N; ++i) {
    const Motor& motor = motors_[static_cast<std::size_t>(i)];
    const Eigen::Vector3d arm = motor.arm(theta_rad[i]);
    const Eigen::Vector3d rod = motor.at_zero.crank_centre_m + arm - rod_end(motor, q_rad);
    const double lever = rod.dot(motor.at_zero.axis.cross(arm));
    for (int j = 0; j < N; ++j) J(i, j) = rod.dot(rod_end_rate(motor, q_rad, j)) / lever;
  }
  return J;
}

template <int N>
auto RodLinkage<N>::to_motors(const Commands& joints, const Angles& q_rad, const Angles& dq_rad_s,
                              const Angles& theta_rad) const noexcept -> Commands {
  const Jacobian J = jacobian(theta_rad, q_rad), inverse = J.inverse();
  Angles torque, q_error, dq_error, kp, kd;
  for (int j = 0; j < N; ++j) {
    const MotorCommand& joint = joints[static_cast<std::size_t>(j)];
    q_error[j] = joint.q_rad - q_rad[j];
    dq_error[j] = joint.dq_rad_s - dq_rad_s[j];
    kp[j] = joint.kp_Nm_per_rad;
    kd[j] = joint.kd_Nm_s_per_rad;
    torque[j] = kp[j] * q_error[j] + kd[j] * dq_error[j] + joint.torque_Nm;
  }
  const Angles motor_torque = inverse.transpose() * torque, theta_error = J * q_error,
               dtheta_des = J * (dq_error + dq_rad_s), dtheta = J * dq_rad_s;
  const Jacobian stiffness = inverse.transpose() * kp.asDiagonal() * inverse,
                 damping = inverse.transpose() * kd.asDiagonal() * inverse;
  Commands motors{};
  for (int i = 0; i < N; ++i) {
    MotorCommand& motor = motors[static_cast<std::size_t>(i)];
    motor.q_rad = theta_rad[i] + theta_error[i];
    motor.dq_rad_s = dtheta_des[i];
    motor.kp_Nm_per_rad = stiffness(i, i);
    motor.kd_Nm_s_per_rad = damping(i, i);
    motor.torque_Nm = motor_torque[i] - stiffness(i, i) * theta_error[i] - damping(i, i) * (dtheta_des[i] - dtheta[i]);
  }
  return motors;
}

template <int N>
template <typename Visit>
void RodLinkage<N>::for_grid(const Angles& lower_rad, const Angles& upper_rad, Visit&& visit) {
  constexpr int kSecond = N == 2 ? kGrid : 1;
  for (int m = 0; m < kGrid; ++m) {
    for (int n = 0; n < kSecond; ++n) {
      Angles share;
      share[0] = static_cast<double>(m) / (kGrid - 1);
      if constexpr (N == 2) share[1] = static_cast<double>(n) / (kGrid - 1);
      visit(Angles(lower_rad + share.cwiseProduct(upper_rad - lower_rad)));
    }
  }
}

template <int N>
void RodLinkage<N>::check_ranges(const Angles& lower_rad, const Angles& upper_rad) const {
  for_grid(lower_rad, upper_rad, [this](const Angles& q) {
    const std::string where =
        fmt::format("at joint angle{}",
                    N == 2 ? fmt::format("s {:.3f} and {:.3f} rad", q[0], q[N - 1]) : fmt::format(" {:.3f} rad", q[0]));
    const std::optional<Angles> theta = motor_angles(q);
    if (!theta)
      throw std::invalid_argument(where + " a rod doesn't reach; expected a linkage that covers the joints' ranges");
    for (int i = 0; i < N; ++i) {
      const double value = sine(motors_[static_cast<std::size_t>(i)], (*theta)[i], q);
      if (std::abs(value) >= kLeastSine) continue;
      throw std::invalid_argument(
          fmt::format("{} crank and rod of motor {} are nearly in line (sine {:.2f}); expected {} or more", where, i,
                      value, kLeastSine));
    }
    const Jacobian J = jacobian(*theta, q);
    // Singular values of a 2 x 2 matrix: s^2 = (t +- sqrt(t^2 - 4 d^2)) / 2 with t = |J|^2, d = det J.
    const double t = J.squaredNorm(), d = std::abs(J.determinant());
    const double largest = N == 1 ? d : std::sqrt(0.5 * (t + std::sqrt(std::max(0.0, t * t - 4.0 * d * d))));
    const double condition = N == 1 ? 1.0 : largest * largest / d;
    if (condition <= kMostCondition && largest * kMostCondition >= 1.0) return;
    throw std::invalid_argument(
        fmt::format("{} the linkage is nearly singular (condition {:.1f}, largest ratio {:.3f}); expected at most {}",
                    where, condition, largest, kMostCondition));
  });
}

template <int N>
auto RodLinkage<N>::needs(const std::array<MotorLimits, kN>& joints, const Commands& gains) const
    -> std::array<Needs, kN> {
  Angles lower, upper, dq, torque, kp, kd;
  for (int j = 0; j < N; ++j) {
    const MotorLimits& joint = joints[static_cast<std::size_t>(j)];
    lower[j] = joint.q_lower_rad;
    upper[j] = joint.q_upper_rad;
    dq[j] = joint.dq_rad_s;
    torque[j] = joint.torque_Nm;
    kp[j] = gains[static_cast<std::size_t>(j)].kp_Nm_per_rad;
    kd[j] = gains[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
  }
  std::array<Needs, kN> needs{};
  bool first = true;
  for_grid(lower, upper, [&](const Angles& q) {
    const Angles theta = *motor_angles(q);
    const Jacobian J = jacobian(theta, q), inverse = J.inverse();
    const Angles speeds = J.cwiseAbs() * dq, torques = inverse.transpose().cwiseAbs() * torque;
    const Jacobian stiffness = inverse.transpose() * kp.asDiagonal() * inverse,
                   damping = inverse.transpose() * kd.asDiagonal() * inverse;
    for (int i = 0; i < N; ++i) {
      Needs& need = needs[static_cast<std::size_t>(i)];
      need.limits.q_lower_rad = first ? theta[i] : std::min(need.limits.q_lower_rad, theta[i]);
      need.limits.q_upper_rad = first ? theta[i] : std::max(need.limits.q_upper_rad, theta[i]);
      need.limits.dq_rad_s = std::max(need.limits.dq_rad_s, speeds[i]);
      need.limits.torque_Nm = std::max(need.limits.torque_Nm, torques[i]);
      need.gains.kp_Nm_per_rad = std::max(need.gains.kp_Nm_per_rad, stiffness(i, i));
      need.gains.kd_Nm_s_per_rad = std::max(need.gains.kd_Nm_s_per_rad, damping(i, i));
    }
    first = false;
  });
  return needs;
}

template class RodLinkage<1>;
template class RodLinkage<2>;

}  // namespace pmg::drives
