#include "live_page/page_hand.hpp"

namespace pmg::live_page {

void PageHand::take(const HandNews& news, std::int64_t now_ns) noexcept {
  if (news.number <= number_) return;
  number_ = news.number;
  late_ = transit_.take(news.stamp_ns, now_ns) > ops::Device::kLate_ns;
  const bool pressed = presses_ >= 0 && news.presses > presses_;
  if (presses_ < 0 || news.presses > presses_) presses_ = news.presses;
  if (late_) {
    hold_.down = hold_.down && news.held;  // its silence ends what it drove; an old press doesn't count
    return;
  }
  main_ = ops::shaped(kStick, news.forwards, news.turn);
  side_ = ops::shaped(kStick, news.left, 0.0)[0];
  hold_.down = news.held;
  hold_.pressed = hold_.pressed || pressed;
  hold_.neutral = main_[0] == 0.0 && main_[1] == 0.0 && side_ == 0.0;
  hold_.heard_ns = now_ns;
  if (pressed) note_.clear();
}

ops::Hold PageHand::take_hold() noexcept {
  const ops::Hold hold = hold_;
  hold_.pressed = false;
  return hold;
}

}  // namespace pmg::live_page
