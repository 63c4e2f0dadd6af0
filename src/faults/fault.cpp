#include "faults/fault.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace pmg::faults {

namespace {

struct Row {
  FaultCode code = FaultCode::kNone;  // the row's own place in the table
  const char *name = "", *unit = "";
  const char* cause = "";                // with {joint}, {value}, {limit}, {beyond} = |value - limit|
  const char* cause_no_value = nullptr;  // when no joint, or no number, can be named; null: the same
  const char* advice = "";
  CycleRange first;  // when the drives damp, or where the robot may sit down first, when that begins
  bool sit_down = false, policy_is_sound = false;
};

constexpr CycleRange kAtOnce{1, 5}, kThreeTicks{11, 15};

constexpr std::array<Row, kFaultCodes> kRows = {{
    {.code = FaultCode::kNone, .name = "none", .unit = "", .cause = "nothing is wrong", .advice = "", .first = {}},
    {.code = FaultCode::kBusLost,
     .name = "bus_lost",
     .unit = "",
     .cause = "the drives don't answer any more",
     .advice = "Look at the drives' power and the bus wiring; the drives' own watchdogs must have stopped them.",
     .first = kAtOnce},
    {.code = FaultCode::kStaleState,
     .name = "stale_state",
     .unit = "s",
     .cause = "no news from the drives for {value:.3f} s, limit {limit:.3f} s",
     .advice = "Look at the bus: drives that answer late or a bus thread that does not run.",
     .first = {16, 20}},
    {.code = FaultCode::kStateNotFinite,
     .name = "state_not_finite",
     .unit = "",
     .cause = "{joint} reports a value that is no number",
     .cause_no_value = "the state is incomplete, or the IMU reports what is no number or no orientation",
     .advice = "Look at the encoder, torque sensor or IMU that is named in the log's last STATE.",
     .first = kAtOnce},
    {.code = FaultCode::kTemperature,
     .name = "temperature",
     .unit = "degC",
     .cause = "{joint}'s drive has {value:.1f} degC, limit {limit:.1f} degC",
     .cause_no_value = "{joint}'s drive reports no temperature",
     .advice = "Let the drive cool down; look at what it had to hold.",
     .first = kAtOnce,
     .sit_down = true,
     .policy_is_sound = true},
    {.code = FaultCode::kControlFrozen,
     .name = "control_frozen",
     .unit = "",
     .cause = "the control thread gave no command for too long; the bus damped the drives meanwhile",
     .advice = "Look at what else ran on the computer, and at what real-time scheduling was refused at the start.",
     .first = {22, 26}},
    {.code = FaultCode::kCommandNotFinite,
     .name = "command_not_finite",
     .unit = "",
     .cause = "the control thread gave a command that was no number; the bus damped the drives",
     .advice = "A defect of the controller: keep the log and report it.",
     .first = {0, 0}},
    {.code = FaultCode::kStalePolicy,
     .name = "stale_policy",
     .unit = "",
     .cause = "the policy gave no result in time, several ticks in a row",
     .advice = "Look at the policy's times in TIMING: too large a network, or a computer that is too busy.",
     .first = kThreeTicks,
     .sit_down = true},
    {.code = FaultCode::kOverrun,
     .name = "overrun",
     .unit = "s",
     .cause = "several ticks in a row ended behind their deadline, the last one by {value:.4f} s",
     .advice = "Look at the stages' times in TIMING, and at what else ran on the computer.",
     .first = {18, 22},
     .sit_down = true,
     .policy_is_sound = true},
    {.code = FaultCode::kJointLimit,
     .name = "joint_limit",
     .unit = "rad",
     .cause = "{joint} is at {value:.3f} rad, {beyond:.3f} rad beyond its range",
     .advice = "Bring the joint back into its range by hand; look at its zero and at what drove it there.",
     .first = kThreeTicks},
    {.code = FaultCode::kJointVelocity,
     .name = "joint_velocity",
     .unit = "rad/s",
     .cause = "{joint} moves at {value:.2f} rad/s, limit {limit:.2f} rad/s",
     .advice = "Look at the joint's encoder, its gains and what it hit.",
     .first = kThreeTicks},
    {.code = FaultCode::kJointTorque,
     .name = "joint_torque",
     .unit = "Nm",
     .cause = "{joint} gives {value:.1f} Nm, limit {limit:.1f} Nm",
     .advice = "Look at what the joint pushed against.",
     .first = kThreeTicks,
     .sit_down = true,
     .policy_is_sound = true},
    {.code = FaultCode::kTilt,
     .name = "tilt",
     .unit = "rad",
     .cause = "the IMU's link leans {value:.2f} rad from upright, limit {limit:.2f} rad",
     .advice = "The robot fell or was tipped: put it upright before the reset, a simulated one by pmg_send lift.",
     .first = kThreeTicks},
    {.code = FaultCode::kTorsoAttitude,
     .name = "torso_attitude",
     .unit = "rad",
     .cause = "the torso leans {value:.2f} rad away from what was commanded, limit {limit:.2f} rad",
     .advice = "The robot lost its balance or was held: put it upright before it stands again, a simulated one by "
               "pmg_send lift.",
     .first = kThreeTicks},
    {.code = FaultCode::kReferenceNotFinite,
     .name = "reference_not_finite",
     .unit = "",
     .cause = "the motion generator or the ground-aware optimisation gave what is no number",
     .advice = "A defect of the clip library or the controller: keep the log and report it.",
     .first = kAtOnce,
     .sit_down = true,
     .policy_is_sound = true},
    {.code = FaultCode::kPolicyNotFinite,
     .name = "policy_not_finite",
     .unit = "",
     .cause = "the policy failed, or gave a target that is no number",
     .advice = "Walk without this policy; keep the log and report it.",
     .first = kAtOnce,
     .sit_down = true},
    {.code = FaultCode::kActionOutOfRange,
     .name = "action_out_of_range",
     .unit = "rad",
     .cause = "the policy pulls {joint} {value:.2f} rad away from its reference, limit {limit:.2f} rad",
     .advice = "The robot is not in a state that the policy was trained for, or it is the wrong policy.",
     .first = {96, 100}},
}};
static_assert([] {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  return true;
}());

const Row& row(FaultCode code) noexcept { return kRows[static_cast<std::size_t>(code)]; }

}  // namespace

bool allows_sit_down(FaultCode code) noexcept { return row(code).sit_down; }

bool policy_is_sound_after(FaultCode code) noexcept { return row(code).policy_is_sound; }

Reaction reaction(FaultCode code) noexcept {
  // control::SitDownOptions' two ways: a robot that takes steps, and that no policy balances any more, is damped
  // sooner.
  constexpr int kSitDown = 500, kUnbalanced = 400;
  const int least = row(code).policy_is_sound ? kSitDown : kUnbalanced;
  const CycleRange first = row(code).first;
  if (!row(code).sit_down) return {{}, first};
  return {first, {first.least + least, first.most + kSitDown}};
}

const char* to_string(FaultCode code) noexcept { return row(code).name; }

const char* unit(FaultCode code) noexcept { return row(code).unit; }

const char* advice(FaultCode code) noexcept { return row(code).advice; }

std::string describe(const Fault& fault, const model::RobotModel& robot) {
  const Row& words = row(fault.code);
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
