#include "gamepad/pad_command.hpp"

#include <algorithm>
#include <utility>

namespace pmg::gamepad {

namespace {

ops::Request request_of(Action action) {
  switch (action) {
    case Action::kStand:
      return ops::Request::kStand;
    case Action::kReset:
      return ops::Request::kReset;
    case Action::kLimp:
      return ops::Request::kLimp;
    case Action::kLift:
      return ops::Request::kLift;
    default:
      return ops::Request::kSetDown;
  }
}

}  // namespace

ops::DeviceManner PadCommand::manner() const {
  const auto rows = mapping_rows(mapping_);
  const std::string deadman = kButtonNames[mapping_.deadman];
  const std::size_t first = rows.size() - mapping_.chords.size();
  const std::string raises = rows[first][0] + " makes it stand up";
  return {.name = "gamepad",
          .command_raises = false,
          .at_once = false,
          .raises = raises,
          .resets = rows[first + 1][0] + " resets it",
          .drives = deadman + " and a stick drive it",
          .starts = raises,
          .lifts = rows[first + 3][0] + " lifts it",
          .sets_down = rows[first + 4][0] + " sets it down",
          .anew = "Press " + deadman + " anew, with neutral sticks"};
}

void PadCommand::take(std::span<const PadReport> pads, std::int64_t now_ns) {
  for (const PadReport& pad : pads) {
    if (pad.missing[mapping_.stop]) continue;
    PadHand& hand = hands_.try_emplace(pad.id, pad.id).first->second;
    hand.take(pad.state, mapping_, now_ns);
    requests_.stop = requests_.stop || hand.stop();
    if (hand.action() && !driving_) requests_.other = request_of(*hand.action());
  }
  std::erase_if(hands_, [&](const auto& entry) {
    return std::ranges::none_of(pads, [&](const PadReport& pad) { return pad.id == entry.first && !pad.gone; });
  });
}

std::span<const ops::Hold> PadCommand::holds(std::int64_t /*now_ns*/) noexcept {
  holds_.clear();
  for (auto& [id, hand] : hands_) holds_.push_back(hand.take_hold());
  return holds_;
}

Command PadCommand::command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept {
  const auto hand = armed ? hands_.find(*armed) : hands_.end();
  driving_ = hand == hands_.end() ? std::nullopt : armed;
  if (driving_) {
    follow(hand->second, static_cast<double>(now_ns - commanded_ns_) * 1e-9);
  } else {
    command_ = Command{};
  }
  commanded_ns_ = now_ns;
  return command_;
}

ops::Requests PadCommand::take_requests() noexcept { return std::exchange(requests_, ops::Requests{}); }

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
  driving_.reset();
  command_[kVx] = command_[kVy] = command_[kOmega] = 0.0;
}

void PadCommand::upright() noexcept { command_[kPitch] = command_[kRoll] = command_[kHeight] = 0.0; }

}  // namespace pmg::gamepad
