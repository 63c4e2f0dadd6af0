// The arms of a robot that has some, led by the driving source's targets.
#pragma once

#include "arms/arms.hpp"
#include "control/arms_message.hpp"
#include "pmg/reference.hpp"

namespace pmg::control {

class LedArms {
 public:
  /// Throws as arms::Arms does.
  LedArms(const model::RobotModel& robot, const arms::ArmSetup& setup, double dt_s) : arms_(robot, setup, dt_s) {}

  /// The reference moves both arms again: for a robot that isn't upright, whose arms are at q [rad]. Each returns what
  /// the arms do now.
  arms::PerArm<arms::ArmReport> reset(JointVector q) noexcept;

  /// (what is in force; null: nothing; the reference of this tick) => (its arm joints where an operator has them).
  /// Without anything in force both arms stay where they are. No heap.
  arms::PerArm<arms::ArmReport> step(const ArmsMessage* in_force, Reference& reference) noexcept;

  /// (targets of all joints [rad]) => (arms that the reference doesn't move stay as they were in the last step).
  arms::PerArm<arms::ArmReport> keep(JointVector& q) noexcept;

 private:
  arms::PerArm<arms::ArmReport> reports() const noexcept { return {arms_.report(kLeft), arms_.report(kRight)}; }

  arms::Arms arms_;
  JointVector q_;  // of the last step
};

}  // namespace pmg::control
