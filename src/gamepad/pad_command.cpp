#include "gamepad/pad_command.hpp"

#include <algorithm>

namespace pmg::gamepad {

void PadCommand::take(std::span<const PadReport> pads, std::int64_t now_ns) {
  stop_ = false;
  for (const PadReport& pad : pads) {
    PadHand& hand = hands_[pad.id];
    hand.take(pad.state, mapping_, now_ns);
    stop_ = stop_ || hand.stop();
  }
  std::erase_if(hands_, [&](const auto& entry) {
    return std::ranges::none_of(pads, [&](const PadReport& pad) { return pad.id == entry.first && !pad.gone; });
  });
  choose();
  const bool moved = command_ != Command{};
  if (driving_) {
    follow(hands_.at(*driving_), static_cast<double>(now_ns - taken_ns_) * 1e-9);
  } else {
    command_ = Command{};
  }
  if (!moved && command_ != Command{}) ++presses_;
  taken_ns_ = now_ns;
}

void PadCommand::choose() {
  if (stop_) rest();
  if (driving_ && (!hands_.contains(*driving_) || !hands_.at(*driving_).armed())) driving_.reset();
  action_.reset();
  for (auto& [id, hand] : hands_) {
    if (hand.armed() && !driving_) driving_ = id;
    if (hand.armed() && driving_ != id) hand.disarm();  // it must be pressed again when the other has let go
  }
  for (const auto& [id, hand] : hands_) {
    if (!driving_ && !stop_ && hand.action()) action_ = hand.action();
  }
}

void PadCommand::follow(const PadHand& hand, double dt_s) noexcept {
  for (std::size_t i = 0; i < kChannels; ++i) {
    const ChannelMap& map = mapping_.channels[i];
    const double share = map.sign * hand.sticks()[map.axis];
    const double range = share > 0.0 ? limits_.upper[i] : -limits_.lower[i];
    double& u = command_.u[i];
    if (i >= kVelocityChannels) {  // a posture moves while its stick is out, and stays
      const double step = hand.bends() ? share * range * dt_s / map.full_in_s : 0.0;
      u = hand.upright() ? 0.0 : std::clamp(u + step, limits_.lower[i], limits_.upper[i]);
      continue;
    }
    const bool taken =
        hand.bends() && std::any_of(mapping_.channels.begin() + kVelocityChannels, mapping_.channels.end(),
                                    [&](const ChannelMap& other) { return other.axis == map.axis; });
    const double wanted = taken ? 0.0 : share * range;
    // Braking is never slowed: the limit holds for what leads away from zero.
    const double from = u * wanted > 0.0 ? u : 0.0, step = range * dt_s / map.full_in_s;
    u = wanted > 0.0 ? std::min(wanted, from + step) : std::max(wanted, from - step);
  }
}

const char* PadCommand::text(std::int32_t pad) const noexcept {
  const auto found = hands_.find(pad);
  return found == hands_.end() ? "" : found->second.text();
}

void PadCommand::rest() noexcept {
  for (auto& [id, hand] : hands_) hand.disarm();
  driving_.reset();
  command_[kVx] = command_[kVy] = command_[kOmega] = 0.0;
}

void PadCommand::upright() noexcept { command_[kPitch] = command_[kRoll] = command_[kHeight] = 0.0; }

}  // namespace pmg::gamepad
