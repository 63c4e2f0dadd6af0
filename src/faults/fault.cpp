#include "faults/fault.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace pmg::faults {

namespace {

struct Wording {
  const char* name;
  const char* unit;
  const char* cause;           // with {joint}, {value}, {limit}, {beyond} = |value - limit|
  const char* cause_no_value;  // when no joint, or no number, can be named; null: the same
  const char* advice;
};

constexpr std::array<Wording, kFaultCodes> kWordings = {{
    {"none", "", "nothing is wrong", nullptr, ""},
    {"bus_lost", "", "the drives don't answer any more", nullptr,
     "Look at the drives' power and the bus wiring; the drives' own watchdogs must have stopped them."},
    {"stale_state", "s", "no news from the drives for {value:.3f} s, limit {limit:.3f} s", nullptr,
     "Look at the bus: drives that answer late or a bus thread that does not run."},
    {"state_not_finite", "", "{joint} reports a value that is no number",
     "the state is incomplete, or the IMU reports what is no number or no orientation",
     "Look at the encoder, torque sensor or IMU that is named in the log's last STATE."},
    {"temperature", "degC", "{joint}'s drive has {value:.1f} degC, limit {limit:.1f} degC",
     "{joint}'s drive reports no temperature", "Let the drive cool down; look at what it had to hold."},
    {"control_frozen", "", "the control thread gave no command for too long; the bus damped the drives meanwhile",
     nullptr, "Look at what else ran on the computer, and at what real-time scheduling was refused at the start."},
    {"command_not_finite", "", "the control thread gave a command that was no number; the bus damped the drives",
     nullptr, "A defect of the controller: keep the log and report it."},
    {"stale_policy", "", "the policy gave no result in time, several ticks in a row", nullptr,
     "Look at the policy's times in TIMING: too large a network, or a computer that is too busy."},
    {"overrun", "s", "several ticks in a row ended behind their deadline, the last one by {value:.4f} s", nullptr,
     "Look at the stages' times in TIMING, and at what else ran on the computer."},
    {"joint_limit", "rad", "{joint} is at {value:.3f} rad, {beyond:.3f} rad beyond its range", nullptr,
     "Bring the joint back into its range by hand; look at its zero and at what drove it there."},
    {"joint_velocity", "rad/s", "{joint} moves at {value:.2f} rad/s, limit {limit:.2f} rad/s", nullptr,
     "Look at the joint's encoder, its gains and what it hit."},
    {"joint_torque", "Nm", "{joint} gives {value:.1f} Nm, limit {limit:.1f} Nm", nullptr,
     "Look at what the joint pushed against."},
    {"tilt", "rad", "the IMU's link leans {value:.2f} rad from upright, limit {limit:.2f} rad", nullptr,
     "The robot fell or was tipped: put it upright before the reset, a simulated one by pmg_send lift."},
    {"torso_attitude", "rad", "the torso leans {value:.2f} rad away from what was commanded, limit {limit:.2f} rad",
     nullptr,
     "The robot lost its balance or was held: put it upright before it stands again, a simulated one by pmg_send "
     "lift."},
    {"reference_not_finite", "", "the motion generator or the ground-aware optimisation gave what is no number",
     nullptr, "A defect of the clip library or the controller: keep the log and report it."},
    {"policy_not_finite", "", "the policy failed, or gave a target that is no number", nullptr,
     "Walk without this policy; keep the log and report it."},
    {"action_out_of_range", "rad",
     "the policy pulls {joint} {value:.2f} rad away from its reference, limit {limit:.2f} rad", nullptr,
     "The robot is not in a state that the policy was trained for, or it is the wrong policy."},
}};

const Wording& wording(FaultCode code) noexcept { return kWordings[static_cast<std::size_t>(code)]; }

}  // namespace

bool allows_sit_down(FaultCode code) noexcept {
  switch (code) {
    case FaultCode::kTemperature:
    case FaultCode::kStalePolicy:
    case FaultCode::kOverrun:
    case FaultCode::kJointTorque:
    case FaultCode::kReferenceNotFinite:
    case FaultCode::kPolicyNotFinite:
      return true;
    case FaultCode::kNone:
    case FaultCode::kBusLost:
    case FaultCode::kStaleState:
    case FaultCode::kStateNotFinite:
    case FaultCode::kControlFrozen:
    case FaultCode::kCommandNotFinite:
    case FaultCode::kJointLimit:
    case FaultCode::kJointVelocity:
    case FaultCode::kTilt:
    case FaultCode::kTorsoAttitude:
    case FaultCode::kActionOutOfRange:
      return false;
  }
  return false;
}

bool policy_is_sound_after(FaultCode code) noexcept {
  return code == FaultCode::kTemperature || code == FaultCode::kOverrun || code == FaultCode::kJointTorque ||
         code == FaultCode::kReferenceNotFinite;
}

Reaction reaction(FaultCode code) noexcept {
  static constexpr CycleRange kNever{}, kAtOnce{1, 5}, kThreeTicks{11, 15};
  const auto at_once = [](const CycleRange& damping) { return Reaction{kNever, damping}; };
  const auto after_sit_down = [](const CycleRange& found) {
    constexpr int kSitDown = 500;  // SitDownOptions: 1 s
    return Reaction{found, {found.least + kSitDown, found.most + kSitDown}};
  };
  switch (code) {
    case FaultCode::kNone:
      return {};
    case FaultCode::kBusLost:
    case FaultCode::kStateNotFinite:
      return at_once(kAtOnce);
    case FaultCode::kStaleState:
      return at_once({16, 20});
    case FaultCode::kTemperature:
    case FaultCode::kReferenceNotFinite:
    case FaultCode::kPolicyNotFinite:
      return after_sit_down(kAtOnce);
    case FaultCode::kControlFrozen:
      return at_once({22, 26});
    case FaultCode::kCommandNotFinite:
      return at_once({0, 0});
    case FaultCode::kStalePolicy:
    case FaultCode::kJointTorque:
      return after_sit_down(kThreeTicks);
    case FaultCode::kOverrun:
      return after_sit_down({18, 22});
    case FaultCode::kJointLimit:
    case FaultCode::kJointVelocity:
    case FaultCode::kTilt:
    case FaultCode::kTorsoAttitude:
      return at_once(kThreeTicks);
    case FaultCode::kActionOutOfRange:
      return at_once({96, 100});
  }
  return {};
}

const char* to_string(FaultCode code) noexcept { return wording(code).name; }

const char* unit(FaultCode code) noexcept { return wording(code).unit; }

const char* advice(FaultCode code) noexcept { return wording(code).advice; }

std::string describe(const Fault& fault, const model::RobotModel& robot) {
  const Wording& words = wording(fault.code);
  const bool joint_missing = fault.code == FaultCode::kStateNotFinite && fault.joint < 0;
  const bool other_words = words.cause_no_value != nullptr && (joint_missing || !std::isfinite(fault.value));
  const std::string joint = fault.joint >= 0 ? robot.joint_index.name(fault.joint) : "a joint";
  return fmt::format(
      "{}: {}", words.name,
      fmt::format(fmt::runtime(other_words ? words.cause_no_value : words.cause), fmt::arg("joint", joint),
                  fmt::arg("value", fault.value), fmt::arg("limit", fault.limit),
                  fmt::arg("beyond", std::abs(fault.value - fault.limit))));
}

}  // namespace pmg::faults
