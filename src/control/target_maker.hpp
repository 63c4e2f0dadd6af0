// Who tells the drives where to go, one in each tick. The transitions are a table of docs/reference/safety.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pmg::control {

enum class TargetMaker : std::uint8_t {
  kNobody,              ///< the drives are limp or brake
  kReferenceUnjudged,   ///< the reference alone: Stand has begun, and the feet are not judged yet
  kReferenceHanging,    ///< the reference alone: the feet carry nothing
  kReferenceRehearsed,  ///< the reference alone: the feet carry, and the policy runs unsent until it is known
  kPolicy,              ///< the policy
  kLoweredByPolicy,     ///< in a sit-down: the reference goes down, and the policy balances
  kLoweredByReference,  ///< in a sit-down: the reference goes down alone
  kLoweredToTheCrouch,  ///< in a sit-down: the joints go to the crouch
};
inline constexpr std::size_t kTargetMakers = 8;

constexpr const char* to_string(TargetMaker maker) {
  constexpr std::array<const char*, kTargetMakers> names = {
      "nobody", "reference, feet not judged", "reference, hanging",  "reference, policy unsent",
      "policy", "sit-down, policy",           "sit-down, reference", "sit-down, crouch"};
  return names[static_cast<std::size_t>(maker)];
}

enum class TargetEvent : std::uint8_t {
  kStandBegins,             ///< with a policy that needs no ground
  kStandBeginsOnTheGround,  ///< with one that needs it
  kFeetCarry,
  kFeetCarryNothing,
  kPolicyIsKnown,        ///< it ran unsent for long enough, and its first step is small
  kFaultWithAPolicy,     ///< a fault from which the robot sits down, and the policy is sound
  kFaultWithoutAPolicy,  ///< the same, and it isn't
  kPolicyFails,
  kReferenceIsDown,  ///< or of no more use
  kReleased,         ///< any mode without a posture; a sit-down that is over or broken off
};
inline constexpr std::size_t kTargetEvents = 10;

constexpr const char* to_string(TargetEvent event) {
  constexpr std::array<const char*, kTargetEvents> names = {"Stand begins, no ground needed",
                                                            "Stand begins",
                                                            "the feet carry",
                                                            "the feet carry nothing",
                                                            "the policy is known",
                                                            "fault, the policy is sound",
                                                            "fault, the policy isn't sound",
                                                            "the policy fails",
                                                            "the reference is down",
                                                            "release"};
  return names[static_cast<std::size_t>(event)];
}

/// (maker, event) => (maker). An event that means nothing to a maker changes nothing.
constexpr TargetMaker next(TargetMaker now, TargetEvent event) {
  using enum TargetMaker;
  const bool unready = now == kReferenceUnjudged || now == kReferenceHanging;
  switch (event) {
    case TargetEvent::kStandBegins:
      return now == kNobody ? kPolicy : now;
    case TargetEvent::kStandBeginsOnTheGround:
      return now == kNobody ? kReferenceUnjudged : now;
    case TargetEvent::kFeetCarry:
      return unready ? kReferenceRehearsed : now;
    case TargetEvent::kFeetCarryNothing:
      return unready || now == kReferenceRehearsed || now == kPolicy ? kReferenceHanging : now;
    case TargetEvent::kPolicyIsKnown:
      return now == kReferenceRehearsed ? kPolicy : now;
    case TargetEvent::kFaultWithAPolicy:
      return now == kPolicy ? kLoweredByPolicy : now;
    case TargetEvent::kFaultWithoutAPolicy:
      return now == kPolicy ? kLoweredByReference : now;
    case TargetEvent::kPolicyFails:
      return now == kLoweredByPolicy ? kLoweredByReference : now;
    case TargetEvent::kReferenceIsDown:
      return now == kLoweredByPolicy || now == kLoweredByReference ? kLoweredToTheCrouch : now;
    case TargetEvent::kReleased:
      return kNobody;
  }
  return now;
}

/// The feet carry nothing: only in Stand, and in Walk for the tick in which that is seen.
constexpr bool hanging(TargetMaker maker) { return maker == TargetMaker::kReferenceHanging; }
/// The policy needs the ground, and the feet aren't known to carry the robot, or it isn't known itself. It runs unsent.
constexpr bool policy_waits(TargetMaker maker) {
  return hanging(maker) || maker == TargetMaker::kReferenceUnjudged || maker == TargetMaker::kReferenceRehearsed;
}
/// In Fault: the robot is lowered before the drives damp.
constexpr bool sitting_down(TargetMaker maker) { return maker >= TargetMaker::kLoweredByPolicy; }
constexpr bool runs_policy(TargetMaker maker) {
  return maker == TargetMaker::kPolicy || maker == TargetMaker::kLoweredByPolicy;
}

}  // namespace pmg::control
