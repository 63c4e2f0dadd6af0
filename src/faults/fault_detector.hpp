// Finds faults at the start of a tick, before anything is computed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "faults/fault.hpp"
#include "faults/torso_attitude.hpp"
#include "hal/command_guard.hpp"
#include "hal/hal.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::faults {

struct FaultLimits {
  double stale_state_s = 0.02;     ///< two control ticks without news from the bus
  double temperature_degC = 90.0;  ///< windings survive 120: assumption, no data sheet of these drives is published
  double joint_limit_margin_rad = 0.10;  ///< beyond the URDF's range: what hard stops give under impact
  double velocity_factor = 1.5;          ///< of the URDF's speed limit
  double torque_factor = 1.2;            ///< of the URDF's effort limit
  double tilt_rad = 1.0;                 ///< of the IMU's link from upright
  double torso_error_rad = 0.6;          ///< of the torso from its commanded pitch and roll
  /// Limit, velocity, torque and attitude must be wrong in so many samples in a row: one glitch of a sensor is no
  /// fault. A tick that sees its predecessor's sample again counts nothing.
  int persist_ticks = 3;
  int overrun_ticks = 3;  ///< ticks that end late, or whose policy does, must follow each other so long
  /// A stale state is a fault when a tick this much later still finds the state stale. A host that stops both threads
  /// for a while may wake the control thread first, which then finds an old state once; within this time the bus brings
  /// two new ones. Less than a tick, so that a thread that wakes a little early waits for no third tick.
  /// When the control thread itself was away for longer than stale_state_s, the bus has stale_state_s from its return
  /// on, once: a system that shares its CPUs may hold one of the two threads some 50 ms longer than the other.
  double stale_state_again_s = 0.005;
};

/// The inputs from which a tick judges faults before it computes anything.
struct FaultEvidence {
  const model::RobotState& state;
  hal::BusStatus bus = hal::BusStatus::kOk;
  hal::TripCause guard_trip = hal::TripCause::kNone;  ///< since the last tick
  std::int64_t late_ns = 0;                           ///< the last tick behind its deadline
  bool policy_late = false;                           ///< because of its policy alone
  std::int64_t now_ns = 0;
  std::optional<RollPitchAim> torso =
      std::nullopt;  ///< the commanded attitude of the torso; nullopt while none is commanded
};

/// "Up" of the IMU's link, in the IMU's frame.
Eigen::Vector3d up_of_link(const model::ImuModel& imu) noexcept;

class FaultDetector {
 public:
  enum class Scope {
    kSensing,  ///< bus, state, temperature, guard, timing
    kMotion,   ///< those, and joint limits, velocities, torques and attitude
  };

  FaultDetector(const model::RobotModel& robot, const FaultLimits& limits);

  /// (evidence, scope) => (first fault in the order of FaultCode). Call it once a tick.
  std::optional<Fault> detect(const FaultEvidence& evidence, Scope scope) noexcept;

  /// The state is new, whole and finite, nothing says that the drives or the control thread failed, and the IMU's link
  /// is within the tilt limit. Remembers nothing.
  bool robot_is_sound(const FaultEvidence& evidence) const noexcept;

  /// The IMU's link leans beyond the tilt limit. False for an orientation that isn't finite: that is another fault.
  bool leans_too_far(const model::RobotState& state) const noexcept;

  /// Forgets what earlier ticks found.
  void reset() noexcept {
    held_ticks_.fill(0);
    stale_since_ns_.reset();
    last_ns_.reset();
  }

 private:
  Fault check_state(const FaultEvidence& evidence) noexcept;
  Fault check_age(const FaultEvidence& evidence) noexcept;
  Fault check_finite(const model::RobotState& state) const noexcept;
  Fault check_temperature(const model::RobotState& state) const noexcept;
  Fault check_timing(const FaultEvidence& evidence) noexcept;
  Fault check_motion(const FaultEvidence& evidence) noexcept;
  Fault check_joints(FaultCode code, const model::RobotState& state) const noexcept;
  double tilt_rad(const model::RobotState& state) const noexcept;
  Fault check_tilt(const model::RobotState& state) const noexcept;
  Fault check_torso(const FaultEvidence& evidence) noexcept;
  /// The fault, if it was found so many times in a row; this time counts as `counts`.
  Fault persisting(FaultCode code, const Fault& found, int ticks, int counts = 1) noexcept;

  FaultLimits limits_;
  JointVector q_lower_, q_upper_, velocity_limit_, effort_limit_;
  Eigen::Vector3d up_I_ = Eigen::Vector3d::UnitZ();  // "up" of the IMU's link, seen in the IMU frame
  TorsoAttitude torso_;
  std::array<int, kFaultCodes> held_ticks_{};
  std::int64_t sample_ns_ = -1;                 // stamp of the state that the last tick judged
  std::optional<std::int64_t> stale_since_ns_;  // when a tick first found the state stale that is so still
  double stale_known_s_ = 0.0;                  // a fault when it has been known for so long
  std::optional<std::int64_t> last_ns_;         // of the tick before
};

}  // namespace pmg::faults
