// Faults end motion until the operator resets them. Limiting is not a fault (limiter.hpp).
// Reactions: docs/reference/safety.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "model/robot_model.hpp"

namespace pmg::faults {

/// When one tick finds several faults, the first one in this order is the cause. What each means and leads to is a row
/// of fault.cpp.
enum class FaultCode : std::uint8_t {
  kNone = 0,
  kBusLost,
  kStaleState,
  kStateNotFinite,
  kTemperature,
  kControlFrozen,
  kCommandNotFinite,
  kStalePolicy,
  kOverrun,
  kJointLimit,
  kJointVelocity,
  kJointTorque,
  kTilt,
  kTorsoAttitude,
  kReferenceNotFinite,
  kPolicyNotFinite,
  kActionOutOfRange,
  kNoMore  ///< their number
};
inline constexpr auto kFaultCodes = static_cast<std::size_t>(FaultCode::kNoMore);

/// One detected fault. value and limit are in the unit of its code.
struct Fault {
  FaultCode code = FaultCode::kNone;
  int joint = -1;  ///< -1: no particular joint
  double value = 0.0;
  double limit = 0.0;
  std::int64_t stamp_ns = 0;
};

/// A fault stays latched with its first stamp; its value may change.
inline bool same_incident(const Fault& a, const Fault& b) noexcept {
  return a.code == b.code && a.stamp_ns == b.stamp_ns;
}

/// The robot may be lowered before the drives damp (control/sit_down.hpp): bus, joints and control thread still answer,
/// and simulated robots fall more slowly so. A joint that reads a wrong position or speed spoils the way down; a robot
/// whose policy pulled it far away falls already.
bool allows_sit_down(FaultCode code) noexcept;

/// After this fault the policy still gets valid inputs and gives valid results in time.
bool policy_is_sound_after(FaultCode code) noexcept;

/// Bus cycles of 2 ms, from the first one that carries a cause. most -1: never.
struct CycleRange {
  int least = -1, most = -1;
  friend bool operator==(const CycleRange&, const CycleRange&) = default;
};

/// When the robot begins to sit down, and when the drives damp. docs/reference/safety.md has the same numbers.
struct Reaction {
  CycleRange sit_down, damping;
};
/// In Walk, with the feet on the ground.
Reaction reaction(FaultCode code) noexcept;

const char* to_string(FaultCode code) noexcept;
const char* unit(FaultCode code) noexcept;    ///< of value and limit; empty when there are none
const char* advice(FaultCode code) noexcept;  ///< one sentence: the operator's check before the reset

/// One line for people: "joint_limit: left_knee is at 2.612 rad, 0.112 rad beyond its range". Not for a real-time
/// thread.
std::string describe(const Fault& fault, const model::RobotModel& robot);

}  // namespace pmg::faults
