// The last stage of a tick: limits the joint targets. Limiting is not a fault; it is counted.
#pragma once

#include <array>
#include <cstdint>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

struct LimiterOptions {
  /// A target may move by this many times the joint's speed limit: a spring ahead of the joint moves faster than the
  /// joint.
  double target_rate_factor = 3.0;
};

/// Number of joints that were limited in a tick, by reason.
struct LimitReport {
  int position = 0;  ///< target outside the joint's range
  int rate = 0;      ///< target moved too fast
  int torque = 0;    ///< |kp (q_des - q) + kd (dq_des - dq)| above the effort limit

  static constexpr std::uint8_t kRange = 1, kSpeed = 2, kTorque = 4;
  std::array<std::uint8_t, kMaxJoints> by{};  ///< bits of each joint
};

class Limiter {
 public:
  /// kp, kd: the gains that the drives get [Nm/rad], [Nm s/rad].
  Limiter(const model::RobotModel& robot, const JointVector& kp, const JointVector& kd, double dt_s,
          const LimiterOptions& options);

  void set_gains(Eigen::Index joint, double kp_Nm_per_rad, double kd_Nm_s_per_rad) noexcept {
    kp_[joint] = kp_Nm_per_rad;
    kd_[joint] = kd_Nm_s_per_rad;
  }
  void start_from(const JointVector& q) noexcept;  ///< the last tick's targets [rad]
  const JointVector& last() const noexcept { return previous_; }

  /// (state, dq_des, q_des) => (limited q_des, report), in place and in this order:
  /// rate:   |q_des - q_des of the last tick| <= target_rate_factor velocity_limit dt,
  /// torque: |kp (q_des - q) + kd (dq_des - dq)| <= effort_limit,
  /// range:  lower <= q_des <= upper.
  /// The range always holds. When torque and range contradict each other (the joint is beyond its range and the drive
  /// can't brake that hard), the range wins and the drive's own effort limit remains.
  LimitReport apply(const model::RobotState& state, const JointVector& dq_des, JointVector& q_des) noexcept;

 private:
  JointVector lower_, upper_, step_, effort_, kp_, kd_;
  JointVector previous_;
};

}  // namespace pmg::control
