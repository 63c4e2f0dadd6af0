// The last stage before the drives: joint targets that the robot may be given. Limiting is not a fault; it is counted.
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

/// How many joints were limited in a tick, and why.
struct LimitReport {
  int position = 0;  ///< target outside the joint's range
  int rate = 0;      ///< target moved too fast
  int torque = 0;    ///< |kp (q_des - q) - kd dq| above the effort limit

  static constexpr std::uint8_t kRange = 1, kSpeed = 2, kTorque = 4;
  std::array<std::uint8_t, kMaxJoints> by{};  ///< bits of each joint
};

class Limiter {
 public:
  /// kp, kd: what the drives are given [Nm/rad], [Nm s/rad].
  Limiter(const model::RobotModel& robot, const JointVector& kp, const JointVector& kd, double dt_s,
          const LimiterOptions& options);

  void set_gains(Eigen::Index joint, double kp_Nm_per_rad, double kd_Nm_s_per_rad) noexcept {
    kp_[joint] = kp_Nm_per_rad;
    kd_[joint] = kd_Nm_s_per_rad;
  }
  void start_from(const JointVector& q) noexcept;  ///< the posture that targets move away from [rad]

  /// Limits q_des in place: first its rate, then the torque that it asks for at this state, last its range, which
  /// always holds. Between two of them that can't both hold (joint beyond its range, braking harder than the drive can)
  /// range wins and the drive's own effort limit remains.
  LimitReport apply(const model::RobotState& state, JointVector& q_des) noexcept;

 private:
  JointVector lower_, upper_, step_, effort_, kp_, kd_;
  JointVector previous_;
};

}  // namespace pmg::control
