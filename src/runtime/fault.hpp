// Faults: what ends motion until the operator resets it. Limiting is not a fault (limiter.hpp). Reactions:
// docs/safety.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/hal.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::runtime {

enum class FaultCode : std::uint8_t {
  kNone = 0,
  kBusLost,
  kStaleState,
  kStateNotFinite,
  kTemperature,
  kJointLimit,
  kJointVelocity,
  kJointTorque,
  kTilt,
  kPolicyNotFinite,
};
inline constexpr std::size_t kFaultCodes = 10;

/// One detected fault. value and limit are in the unit of its code: s, degC, rad, rad/s, Nm.
struct Fault {
  FaultCode code = FaultCode::kNone;
  int joint = -1;  ///< -1: no particular joint
  double value = 0.0;
  double limit = 0.0;
  std::int64_t stamp_ns = 0;
};

const char* to_string(FaultCode code) noexcept;

/// One line for people: "joint_limit: left_knee at 2.61 rad, limit 2.50 rad". Not for a real-time thread.
std::string describe(const Fault& fault, const model::RobotModel& robot);

struct FaultLimits {
  double stale_state_s = 0.02;     ///< two control ticks without news from the bus
  double temperature_degC = 90.0;  ///< windings survive 120: assumption, no data sheet of these drives is published
  double joint_limit_margin_rad = 0.10;  ///< beyond the URDF's range: what hard stops give under impact
  double velocity_factor = 1.5;          ///< of the URDF's speed limit
  double torque_factor = 1.2;            ///< of the URDF's effort limit
  double tilt_rad = 1.0;                 ///< of the IMU's link from upright
  int persist_ticks = 3;  ///< limit, velocity, torque and tilt must hold so long: one glitch of a sensor is no fault
};

/// What is wrong with a state. Which checks apply depends on whether the robot is supposed to hold itself.
class FaultDetector {
 public:
  enum class Scope {
    kSensing,  ///< bus, age, finiteness, temperature
    kMotion,   ///< those, and joint limits, velocities, torques and tilt
  };

  FaultDetector(const model::RobotModel& robot, const FaultLimits& limits);

  /// One call a tick. The first fault in the order of FaultCode.
  std::optional<Fault> detect(const model::RobotState& state, hal::BusStatus bus, std::int64_t now_ns,
                              Scope scope) noexcept;

 private:
  Fault check_sensing(const model::RobotState& state, hal::BusStatus bus, std::int64_t now_ns) const noexcept;
  Fault check_joints(FaultCode code, const model::RobotState& state) const noexcept;
  Fault check_tilt(const model::RobotState& state) const noexcept;
  bool persists(FaultCode code, bool present) noexcept;

  FaultLimits limits_;
  JointVector q_lower_, q_upper_, velocity_limit_, effort_limit_;
  Eigen::Vector3d up_I_ = Eigen::Vector3d::UnitZ();  // "up" of the IMU's link, seen in the IMU frame
  std::array<int, kFaultCodes> held_ticks_{};
};

}  // namespace pmg::runtime
