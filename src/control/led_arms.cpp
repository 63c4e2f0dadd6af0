#include "control/led_arms.hpp"

namespace pmg::control {

arms::PerArm<arms::ArmReport> LedArms::reset(JointVector q) noexcept {
  arms_.reset();
  JointVector dq = JointVector::Zero(q.size());
  arms_.step(q, dq);
  return reports();
}

arms::PerArm<arms::ArmReport> LedArms::step(const ArmsMessage* in_force, Reference& reference) noexcept {
  for (const Foot arm : {kLeft, kRight}) {
    const ArmTarget target = in_force != nullptr ? in_force->arm[arm] : ArmTarget{};
    switch (target.wish) {
      case ArmWish::kHold:
        arms_.hold(arm);
        break;
      case ArmWish::kAim:
        arms_.aim(arm, target.palm);
        break;
      case ArmWish::kHandBack:
        arms_.hand_back(arm);
        break;
    }
  }
  arms_.step(reference.q, reference.dq);
  q_ = reference.q;
  return reports();
}

arms::PerArm<arms::ArmReport> LedArms::keep(JointVector& q) noexcept {
  for (const Foot arm : {kLeft, kRight}) {
    arms_.hold(arm);
    if (arms_.report(arm).activity == arms::ArmActivity::kReference) continue;
    for (const int joint : arms_.joints(arm)) q[joint] = q_[joint];
  }
  return reports();
}

}  // namespace pmg::control
