// The soft end of a fault: the robot is lowered to a crouch before the drives damp. A robot that is damped while it
// stands falls; one that crouches on its joints' stops has little left to fall.
#pragma once

#include <array>
#include <cstdint>

#include "hal/command_guard.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "policy/policy.hpp"

namespace pmg::control {

/// From the fault to the crouch.
struct WayDown {
  double crouch_s;  ///< to the crouch
  /// Of it a walking robot's reference stops and goes down by its height channel, balanced by the policy if that is
  /// sound; then the joints are lowered.
  double reference_s;
  /// The crouch's centre of mass before the soles' centres, in half lengths of a sole: the damped robot sinks forward
  /// onto its knees and arms. Backward it would fall over its heels.
  double ahead_share;
};

struct SitDownOptions {
  /// Of every robot but the unbalanced. crouch_s 0: every fault damps at once.
  WayDown balanced{.crouch_s = 0.95, .reference_s = 0.4, .ahead_share = 0.35};
  /// Of a robot that walked and that no policy balances any more. Many tip forward meanwhile: so they are low sooner,
  /// and meet the ground with their knees first. The torso's median peak speed is 1.6, 1.4 and 1.4 m/s of three times
  /// 20 robots, the largest 2.4; by the balanced way 2.3, 1.3 and 1.3 m/s, and 2.8.
  WayDown unbalanced{.crouch_s = 0.75, .reference_s = 0.35, .ahead_share = 0.7};
  double settle_s = 0.05;        ///< in the crouch, before the drives damp
  double height_rate_m_s = 0.5;  ///< of the height channel meanwhile
  /// Of the drives' damping after the crouch over robot.yaml's kd, which is sized for swinging joints: a folded robot
  /// sinks more slowly so. Three times Z1's kd, 48 and 9 Nm s/rad, is the most that the fields of its drives' frames
  /// hold.
  double brake_factor = 3.0;
};

class SitDown {
 public:
  enum class Stage {
    kNone,       ///< there is none, or it was broken off
    kReference,  ///< the reference goes down
    kJoints,     ///< the joints go to the crouch
    kDamped,     ///< the crouch was reached
  };

  /// The ways down are those of the library's lowest posture (model/crouch.hpp), under robot.yaml's gains, which
  /// balance the robot under plain PD. Throws std::invalid_argument unless the times are 0 or more and 1 s together at
  /// most, and the other options are plausible.
  SitDown(const model::RobotModel& robot, const ClipLibrary& library, const SitDownOptions& options,
          const hal::GuardOptions& guard);

  const JointVector& crouch() const noexcept { return crouches_[unbalanced_]; }  ///< of the way in force
  const SitDownOptions& options() const noexcept { return options_; }
  const policy::DriveGains& gains() const noexcept { return own_; }     ///< of the joints' way
  const JointVector& brake_kd() const noexcept { return brake_kd_; }    ///< [Nm s/rad], once it is over
  double lowest_m() const noexcept { return lowest_m_; }                ///< of the height channel
  const JointVector& squat_rad() const noexcept { return squat_rad_; }  ///< the library's squat there

  void start(std::int64_t now_ns) noexcept;  ///< with the reference, balanced
  /// From now on by the other way: the robot walked, and its policy has failed.
  void lose_balance() noexcept { unbalanced_ = true; }
  /// (measured posture, targets in force, their gains) => the targets that give the same torque kp (q_des - q) under
  /// robot.yaml's gains.
  const JointVector& same_torque(const JointVector& q, const JointVector& q_des, const JointVector& kp) noexcept;
  /// The same, and the joints' way begins there.
  void lower_joints(const JointVector& q, const JointVector& q_des, const JointVector& kp,
                    std::int64_t now_ns) noexcept;
  void stop() noexcept { stage_ = Stage::kNone; }

  /// By the clock: late ticks don't make it longer.
  Stage stage(std::int64_t now_ns) noexcept;
  bool active(std::int64_t now_ns) noexcept;                  ///< the robot is being lowered
  bool reference_is_due(std::int64_t now_ns) const noexcept;  ///< its time isn't over

  /// The joints' targets at this time.
  void step(std::int64_t now_ns, model::JointCommand& command) const noexcept;

 private:
  const WayDown& way() const noexcept { return unbalanced_ ? options_.unbalanced : options_.balanced; }

  SitDownOptions options_;
  policy::DriveGains own_;
  std::array<JointVector, 2> crouches_;  ///< balanced, unbalanced
  JointVector from_, brake_kd_;
  JointVector squat_rad_;
  double lowest_m_ = 0.0;
  Stage stage_ = Stage::kNone;
  bool unbalanced_ = false;
  std::int64_t start_ns_ = 0, joints_start_ns_ = 0;
};

}  // namespace pmg::control
