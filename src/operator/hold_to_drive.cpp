#include "operator/hold_to_drive.hpp"

#include <algorithm>

namespace pmg::ops {

bool HoldToDrive::counts(const Hold& hold, std::int64_t now_ns) const noexcept {
  return !hold.lost && now_ns - hold.heard_ns <= kDeaf_ns;
}

void HoldToDrive::step(std::span<const Hold> holds, std::int64_t now_ns) {
  const bool paused = stepped_ns_ >= 0 && now_ns - stepped_ns_ > kDeaf_ns;
  const bool deaf_to_presses = paused || forget_presses_;
  stepped_ns_ = now_ns;
  pressed_ = forget_presses_ = false;
  std::erase_if(refused_, [&](std::int32_t id) {
    return std::ranges::none_of(holds, [&](const Hold& hold) { return hold.id == id && hold.down && !hold.pressed; });
  });
  const auto drives = [&](const Hold& hold) {
    return hold.id == armed_ && hold.down && counts(hold, now_ns) && (!hold.pressed || hold.neutral);
  };
  if (paused || std::ranges::none_of(holds, drives)) armed_.reset();
  for (const Hold& hold : holds) {
    if (!hold.pressed || deaf_to_presses || !counts(hold, now_ns) || (armed_ && armed_ != hold.id)) continue;
    if (hold.neutral) {
      pressed_ = true;
      if (hold.down) armed_ = hold.id;
    } else if (hold.down) {
      refused_.insert(hold.id);
    }
  }
}

void HoldToDrive::disarm() noexcept {
  armed_.reset();
  forget_presses_ = true;
}

}  // namespace pmg::ops
