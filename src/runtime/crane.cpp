#include "runtime/crane.hpp"

#include <algorithm>

namespace pmg::runtime {

void Crane::step(const CraneView& view, double dt_s) noexcept {
  const bool down = view.stands && !view.stays_up;
  switch (state_) {
    case CraneState::kFree:
      if (!view.stays_up) return;
      lift_m_ = std::min(view.torso_height_m, kLift_m);  // nothing pulls at first, wherever it lies
      state_ = CraneState::kCatching;
      return;
    case CraneState::kCatching:
      engaged_ = std::min(engaged_ + dt_s / kCatch_s, 1.0);
      lift_m_ = std::min(lift_m_ + kRaise_m_s * dt_s, kLift_m);
      if (engaged_ == 1.0) state_ = CraneState::kLifting;
      return;
    case CraneState::kLifting:
      lift_m_ = std::min(lift_m_ + kRaise_m_s * dt_s, kLift_m);
      if (lift_m_ == kLift_m) state_ = CraneState::kHolding;
      return;
    case CraneState::kHolding:
      carried_s_ = 0.0;
      if (down) state_ = CraneState::kLowering;
      return;
    case CraneState::kLowering:
      if (!down) {
        state_ = CraneState::kLifting;
        return;
      }
      lower(view, dt_s);
      if (carried_s_ >= kCarriedFor_s) state_ = CraneState::kLettingGo;
      return;
    case CraneState::kLettingGo:
      if (!down) {
        lift_m_ = std::max(lift_m_, std::min(view.torso_height_m, kLift_m));
        state_ = CraneState::kCatching;
        return;
      }
      lower(view, dt_s);
      engaged_ = std::max(engaged_ - dt_s / kLetGo_s, 0.0);
      if (engaged_ == 0.0) state_ = CraneState::kFree;
      return;
  }
}

void Crane::lower(const CraneView& view, double dt_s) noexcept {
  lift_m_ = std::max(lift_m_ - kLower_m_s * dt_s, -kSlack_m);
  carried_s_ = view.carried_share > kCarriedShare ? carried_s_ + dt_s : 0.0;
}

}  // namespace pmg::runtime
