#include "sil/crane.hpp"

#include <algorithm>

namespace pmg::sil {

void Crane::step(const CraneView& view, double dt_s) noexcept {
  const bool down = view.stands && !view.stays_up;
  switch (state_) {
    case hal::CraneState::kFree:
      if (!view.stays_up) return;
      lift_m_ = std::min(view.torso_height_m, kLift_m);  // nothing pulls at first, wherever it lies
      state_ = hal::CraneState::kCatching;
      return;
    case hal::CraneState::kCatching:
      engaged_ = std::min(engaged_ + dt_s / kCatch_s, 1.0);
      lift_m_ = std::min(lift_m_ + kRaise_m_s * dt_s, kLift_m);
      if (engaged_ == 1.0) state_ = hal::CraneState::kLifting;
      return;
    case hal::CraneState::kLifting:
      lift_m_ = std::min(lift_m_ + kRaise_m_s * dt_s, kLift_m);
      if (lift_m_ == kLift_m) state_ = hal::CraneState::kHolding;
      return;
    case hal::CraneState::kHolding:
      carried_s_ = 0.0;
      if (down) state_ = hal::CraneState::kLowering;
      return;
    case hal::CraneState::kLowering:
      if (!down) {
        state_ = hal::CraneState::kLifting;
        return;
      }
      lower(view, dt_s);
      if (carried_s_ >= kCarriedFor_s) state_ = hal::CraneState::kLettingGo;
      return;
    case hal::CraneState::kLettingGo:
      if (!down) {
        lift_m_ = std::max(lift_m_, std::min(view.torso_height_m, kLift_m));
        state_ = hal::CraneState::kCatching;
        return;
      }
      lower(view, dt_s);
      engaged_ = std::max(engaged_ - dt_s / kLetGo_s, 0.0);
      if (engaged_ == 0.0) state_ = hal::CraneState::kFree;
      return;
  }
}

void Crane::lower(const CraneView& view, double dt_s) noexcept {
  lift_m_ = std::max(lift_m_ - kLower_m_s * dt_s, -kSlack_m);
  carried_s_ = view.carried_share > kCarriedShare ? carried_s_ + dt_s : 0.0;
}

}  // namespace pmg::sil
