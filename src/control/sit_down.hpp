// The soft end of a fault: the robot is lowered to a crouch under its own gains before the drives damp. A robot that is
// damped while it stands falls; one that crouches has little left to fall.
#pragma once

#include <cstdint>
#include <optional>

#include "control/entry_ramp.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "policy/policy.hpp"

namespace pmg::control {

struct SitDownOptions {
  double duration_s = 0.8;  ///< from the targets in force to the crouch; 0: every fault damps at once
  double settle_s = 0.15;   ///< in the crouch, before the drives damp
};

class SitDown {
 public:
  /// The way down is that of the library's lowest posture (model/crouch.hpp), under robot.yaml's gains, which balance
  /// the robot under plain PD. Throws std::invalid_argument unless the times are 0 or more and 1 s together at most.
  SitDown(const model::RobotModel& robot, const ClipLibrary& library, const SitDownOptions& options);

  const JointVector& crouch() const noexcept { return crouch_; }

  /// (measured posture, targets in force, their gains) => begins. The spring's torque kp (q_des - q) does not jump.
  void start(const JointVector& q, const JointVector& q_des, const JointVector& kp, std::int64_t now_ns) noexcept;
  void stop() noexcept { end_ns_.reset(); }
  /// By the clock: late ticks don't make it longer.
  bool active(std::int64_t now_ns) const noexcept { return end_ns_ && now_ns < *end_ns_; }

  /// One tick: (dt) => (command).
  void step(double dt_s, model::JointCommand& command) noexcept;

  const policy::DriveGains& gains() const noexcept { return own_; }

 private:
  SitDownOptions options_;
  policy::DriveGains own_;
  JointVector crouch_, from_;
  bool known_ = false;  // the library has a crouch
  EntryRamp ramp_;
  std::optional<std::int64_t> end_ns_;
};

}  // namespace pmg::control
