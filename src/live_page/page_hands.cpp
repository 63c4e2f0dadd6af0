#include "live_page/page_hands.hpp"

#include <algorithm>
#include <utility>

namespace pmg::live_page {

void PageHands::look(std::span<const web::Page> open) {
  std::erase_if(hands_, [&](const auto& entry) {
    return std::ranges::none_of(open, [&](const web::Page& page) { return page.id == entry.first; });
  });
  for (const web::Page& page : open)
    if (!page.paired_as.empty()) hands_.try_emplace(page.id, page.id, page.paired_as);
}

void PageHands::take(const web::Said& said, std::int64_t now_ns) {
  if (said.text == web::Server::kStop) {
    requests_.stop = true;
    return;
  }
  const auto found = hands_.find(said.page);
  if (found == hands_.end()) return;
  const auto message = read_message(said.text);
  if (!message) {
    ++malformed_;
    return;
  }
  if (message->hand) found->second.take(*message->hand, now_ns);
  if (message->request) ask(found->second, *message->request);
}

void PageHands::ask(PageHand& hand, ops::Request request) {
  if (driving_) {
    const PageHand* driver = this->hand(*driving_);
    hand.note(driver == &hand || driver == nullptr ? "the robot is being driven: let go of the stick first"
                                                   : driver->name() + " drives the robot: it must let go first");
    return;
  }
  if (!other_.empty()) return hand.note(other_ + " drives the robot: it must let go first");
  hand.note("");
  requests_.other = request;
}

ops::DeviceManner PageHands::manner() const {
  return {.name = "web",
          .command_raises = false,
          .at_once = false,
          .raises = "Stand makes it stand up",
          .resets = "Reset resets it",
          .drives = "a finger on the stick drives it",
          .starts = "Stand makes it stand up",
          .lifts = "Lift lifts it",
          .sets_down = "Set down sets it down",
          .anew = "Let go of the stick and touch it anew"};
}

std::span<const ops::Hold> PageHands::holds(std::int64_t /*now_ns*/) noexcept {
  holds_.clear();
  for (auto& [page, hand] : hands_) holds_.push_back(hand.take_hold());
  return holds_;
}

Command PageHands::command(std::optional<std::int32_t> armed, std::int64_t /*now_ns*/) noexcept {
  const auto found = armed ? hands_.find(*armed) : hands_.end();
  driving_ = found == hands_.end() ? std::nullopt : armed;
  Command command;
  if (!driving_) return command;
  const PageHand& hand = found->second;
  for (const auto& [channel, share] : {std::pair{kVx, hand.forwards()}, {kVy, hand.left()}, {kOmega, hand.turn()}})
    command[channel] = share * (share > 0.0 ? limits_.upper[channel] : -limits_.lower[channel]);
  return command;
}

ops::Requests PageHands::take_requests() noexcept { return std::exchange(requests_, ops::Requests{}); }

const PageHand* PageHands::hand(std::int32_t page) const {
  const auto found = hands_.find(page);
  return found == hands_.end() ? nullptr : &found->second;
}

}  // namespace pmg::live_page
