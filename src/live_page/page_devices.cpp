#include "live_page/page_devices.hpp"

#include <algorithm>

namespace pmg::live_page {

namespace {

ops::DeviceManner joined_manner(ops::DeviceManner manner) {
  manner.drives = "a finger on the stick, or a squeezed grip and a step, drives it";
  manner.resets = "Reset fault on the page resets it";  // the headset's hands have no buttons for these
  manner.lifts = "Lift on the page lifts it";
  manner.sets_down = "Set down on the page sets it down";
  manner.anew = "Let go, and touch the stick or squeeze the grip anew";
  return manner;
}

}  // namespace

PageDevices::PageDevices() : joined_({&hands_, &headset_}, joined_manner(hands_.manner())) {}

void PageDevices::look(std::span<const web::Page> open, std::int64_t now_ns) {
  hands_.look(open);
  const bool gone = std::ranges::none_of(open, [&](const web::Page& page) { return page.id == headset_page_.id; });
  if (headset_page_.id != 0 && gone) {
    headset_.end(now_ns);
    headset_page_ = {};
  }
  hands_.let_other_drive(headset_.driving() ? headset_page_.paired_as : "");
}

void PageDevices::take(const web::Said& said, std::int64_t now_ns) {
  const PageHand* hand = hands_.hand(said.page);
  const auto news = hand == nullptr ? std::nullopt : vr::read_news(said.text);
  if (!news) return hands_.take(said, now_ns);
  if (headset_page_.id == 0) {
    headset_page_ = {.id = said.page, .paired_as = hand->name()};
    headset_.begin(now_ns);
  }
  if (headset_page_.id == said.page) headset_.take(*news, now_ns);
}

bool PageDevices::drives(std::int32_t page) const noexcept {
  return hands_.driving() == page || (headset_.driving() && headset_page_.id == page);
}

std::string PageDevices::note(const web::Page& page) const {
  const PageHand* hand = hands_.hand(page.id);
  if (hand == nullptr || drives(page.id)) return "";
  if (hand->late()) return "this page's messages come late: it can't drive";
  if (!hand->note().empty()) return hand->note();
  const PageHand* driver = hands_.driving() ? hands_.hand(*hands_.driving()) : nullptr;
  if (driver != nullptr) return driver->name() + " drives the robot";
  if (headset_.driving()) return headset_page_.paired_as + " drives the robot";
  if (headset_page_.id == page.id) return headset_.note();
  return hand->held() ? "let go of the stick and touch it anew" : "";
}

}  // namespace pmg::live_page
