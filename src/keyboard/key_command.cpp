#include "keyboard/key_command.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pmg::ops {

namespace {

constexpr std::int64_t kBendPeriod_ns = 100'000'000;  // of a posture key that is held

constexpr std::array<std::pair<std::string_view, Key>, 25> kKeyNames = {{
    {"w", Key::kForwards},     {"up", Key::kForwards},   {"s", Key::kBackwards}, {"down", Key::kBackwards},
    {"a", Key::kTurnLeft},     {"left", Key::kTurnLeft}, {"d", Key::kTurnRight}, {"right", Key::kTurnRight},
    {"q", Key::kStepLeft},     {"e", Key::kStepRight},   {"k", Key::kSquat},     {"i", Key::kRise},
    {"o", Key::kBendForwards}, {"u", Key::kBendBack},    {"j", Key::kLeanLeft},  {"l", Key::kLeanRight},
    {"n", Key::kUpright},      {"space", Key::kRest},    {"escape", Key::kDamp}, {"backspace", Key::kDamp},
    {"enter", Key::kStand},    {"r", Key::kReset},       {"h", Key::kLift},      {"g", Key::kSetDown},
    {"p", Key::kUpright},
}};

struct Push {
  Channel channel;
  double direction;
};

constexpr Push push_of(Key key) {
  constexpr std::array<Push, 12> kPushes = {{{kVx, 1.0},
                                             {kVx, -1.0},
                                             {kOmega, 1.0},
                                             {kOmega, -1.0},
                                             {kVy, 1.0},
                                             {kVy, -1.0},
                                             {kHeight, -1.0},
                                             {kHeight, 1.0},
                                             {kPitch, 1.0},
                                             {kPitch, -1.0},
                                             {kRoll, -1.0},
                                             {kRoll, 1.0}}};
  return kPushes[static_cast<std::size_t>(key)];
}

constexpr std::optional<Request> request_of(Key key) {
  switch (key) {
    case Key::kStand:
      return Request::kStand;
    case Key::kReset:
      return Request::kReset;
    case Key::kLift:
      return Request::kLift;
    case Key::kSetDown:
      return Request::kSetDown;
    default:
      return std::nullopt;
  }
}

constexpr bool moves(Key key) { return key <= Key::kStepRight; }
constexpr bool bends(Key key) { return key > Key::kStepRight && key < Key::kUpright; }

}  // namespace

std::optional<Key> key_named(std::string_view name) noexcept {
  const auto* found = std::ranges::find(kKeyNames, name, &std::pair<std::string_view, Key>::first);
  if (found == kKeyNames.end()) return std::nullopt;
  return found->second;
}

DeviceManner KeyCommand::manner() const {
  return {.name = "keyboard",
          .command_raises = true,
          .at_once = true,
          .raises = "Enter makes it stand up",
          .resets = "R resets it",
          .drives = "a key drives it",
          .starts = "a key makes it stand up and walk",
          .lifts = "H lifts it",
          .sets_down = "G sets it down",
          .anew = "Press a key anew",
          .holds_heading = true};
}

void KeyCommand::press(std::string_view name, bool fast, std::int64_t now_ns) noexcept {
  if (const auto key = key_named(name)) {
    press(*key, fast, now_ns);
  } else {
    press_other();
  }
}

void KeyCommand::repeat(std::string_view name, bool fast, std::int64_t now_ns) noexcept {
  if (const auto key = key_named(name)) repeat(*key, fast, now_ns);
}

void KeyCommand::release(std::string_view name, std::int64_t now_ns) noexcept {
  if (const auto key = key_named(name)) release(*key, now_ns);
}

void KeyCommand::press(Key key, bool fast, std::int64_t now_ns) noexcept {
  pressed_ns_ = sign_ns_ = listened_ns_ = now_ns;  // a key that arrives shows that the window polls
  newest_ = key;
  if (key == Key::kRest) zero();
  if (key == Key::kUpright) upright();
  if (key == Key::kDamp) requests_.stop = true;
  if (const auto request = request_of(key)) requests_.other = request;
  if (!moves(key) && !bends(key)) return;
  hold_.pressed = true;
  if (report_ == KeyReport::kPressOnly) hold_.down = true;
  held_[static_cast<std::size_t>(key)] = {.down = true, .fast = fast, .repeats = false, .seen_ns = now_ns};
  stepped_ns_ = now_ns;
  if (bends(key)) bend(key);
  if (moves(key) && report_ == KeyReport::kPressOnly) change_velocity(key, fast);
}

void KeyCommand::repeat(Key key, bool fast, std::int64_t now_ns) noexcept {
  Held& held = held_[static_cast<std::size_t>(key)];
  if (!held.down) return;
  held.repeats = true;
  held.seen_ns = sign_ns_ = now_ns;
  for (Held& other : held_) other.fast = fast;  // Shift is held or not, for all of them
  if (!bends(key) || now_ns - stepped_ns_ < kBendPeriod_ns) return;
  stepped_ns_ = now_ns;
  bend(key);
}

void KeyCommand::release(Key key, std::int64_t now_ns) noexcept {
  held_[static_cast<std::size_t>(key)].down = false;
  sign_ns_ = now_ns;
}

void KeyCommand::release_all() noexcept {
  for (Held& held : held_) held.down = false;
}

bool KeyCommand::held() const noexcept { return std::ranges::any_of(held_, &Held::down); }

void KeyCommand::rest() noexcept {
  zero();
  hold_.down = false;
}

void KeyCommand::zero() noexcept {
  release_all();
  command_[kVx] = command_[kVy] = command_[kOmega] = 0.0;
}

void KeyCommand::upright() noexcept { command_[kPitch] = command_[kRoll] = command_[kHeight] = 0.0; }

std::span<const Hold> KeyCommand::holds(std::int64_t now_ns) noexcept {
  const bool pressed = std::exchange(hold_.pressed, false);
  if (report_ == KeyReport::kPressAndRelease) {
    forget_lost(now_ns);
    hold_.down = held();
  }
  shown_ = hold_;
  shown_.pressed = pressed;
  shown_.heard_ns = report_ == KeyReport::kPressOnly ? now_ns : listened_ns_;
  return {&shown_, 1};
}

Requests KeyCommand::take_requests() noexcept { return std::exchange(requests_, Requests{}); }

Command KeyCommand::command(std::optional<std::int32_t> /*armed*/, std::int64_t now_ns) noexcept {
  if (report_ == KeyReport::kPressOnly) {
    if (now_ns - pressed_ns_ >= kSilence_ns) zero();
    return command_;
  }
  command_[kVx] = command_[kVy] = command_[kOmega] = 0.0;
  for (std::size_t k = 0; k < kKeys; ++k) {
    const Key key = static_cast<Key>(k);
    if (!moves(key) || !held_[k].down) continue;
    const auto [channel, direction] = push_of(key);
    command_[channel] += end_of_range(channel, direction, held_[k].fast);
  }
  return command_;
}

void KeyCommand::forget_lost(std::int64_t now_ns) noexcept {
  for (std::size_t k = 0; k < kKeys; ++k) {
    Held& held = held_[k];
    const bool repeater = held.repeats && newest_ == static_cast<Key>(k);
    const bool lost = repeater ? now_ns - held.seen_ns > kRepeatLost_ns : now_ns - sign_ns_ > kUnconfirmed_ns;
    if (lost) held.down = false;
  }
}

void KeyCommand::bend(Key key) noexcept {
  const auto [channel, direction] = push_of(key);
  const double step = channel == kHeight ? kHeightStep_m : kAngleStep_rad;
  // On the grid of steps, so that as many back are neutral again, also from the range's end.
  const double wanted = step * std::round(command_[channel] / step + direction);
  command_[channel] = std::clamp(wanted, limits_.lower[channel], limits_.upper[channel]);
}

void KeyCommand::change_velocity(Key key, bool fast) noexcept {
  const auto [channel, direction] = push_of(key);
  const double step = kVelocityStep * std::max(-limits_.lower[channel], limits_.upper[channel]);
  if (step <= 0.0) return;
  const double wanted = step * std::round(command_[channel] / step + direction);
  // A slow press never makes a fast command faster, nor one in the other direction jump.
  const double end = end_of_range(channel, direction, fast);
  const double furthest = direction * std::max(direction * end, direction * command_[channel]);
  command_[channel] = direction * std::min(direction * wanted, direction * furthest);
}

double KeyCommand::end_of_range(Channel channel, double direction, bool fast) const noexcept {
  const double end = direction > 0.0 ? limits_.upper[channel] : limits_.lower[channel];
  return (fast ? 1.0 : kShare) * end;
}

}  // namespace pmg::ops
