#include "gamepad/pad_hand.hpp"

#include <algorithm>
#include <cmath>

#include "operator/hold_to_drive.hpp"

namespace pmg::gamepad {

void PadHand::take(const PadState& state, const Mapping& mapping, std::int64_t now_ns) noexcept {
  const bool first = taken_ns_ < 0;
  const bool paused = !first && now_ns - taken_ns_ > ops::HoldToDrive::kDeaf_ns;
  taken_ns_ = now_ns;
  if (first || state.changed) changed_ns_ = now_ns;
  for (std::size_t s = 0; s < 2; ++s) {
    const auto [x, y] = ops::shaped(mapping.sticks[s], state.axes[2 * s], state.axes[2 * s + 1]);
    sticks_[2 * s] = x;
    sticks_[2 * s + 1] = y;
  }
  stop_ = state.pressed[mapping.stop] || (first && state.held[mapping.stop]);
  bends_ = state.held[mapping.posture];
  upright_ = state.held[mapping.upright];
  follow_deadman(state, mapping, now_ns);
  follow_chords(state, mapping, now_ns, paused);
  released_ |= ~state.held;
  before_ = state.held;
}

void PadHand::follow_deadman(const PadState& state, const Mapping& mapping, std::int64_t now_ns) noexcept {
  const std::size_t deadman = mapping.deadman;
  const bool pressed = state.held[deadman] && released_[deadman] && (!before_[deadman] || state.pressed[deadman]);
  hold_.down = state.held[deadman];
  hold_.pressed = hold_.pressed || pressed;
  hold_.neutral = neutral();
  hold_.heard_ns = now_ns;
  if (!hold_.down || pressed) {
    hold_.lost = false;
    text_ = "";
  }
  if (!hold_.down || hold_.lost) return;
  // A pad may be lost without an event: a wireless one that is out of reach keeps its last state. Neutral sticks ask
  // for no motion, so only sticks that are out need a sign of life.
  const double silent_s = neutral() ? 0.0 : static_cast<double>(now_ns - changed_ns_) * 1e-9;
  hold_.lost = silent_s > mapping.still_s;
  text_ = hold_.lost                         ? "it sent nothing for long and may be lost"
          : 2.0 * silent_s > mapping.still_s ? "it sends nothing: move a stick a little, or the robot stops"
                                             : "";
}

ops::Hold PadHand::take_hold() noexcept {
  const ops::Hold hold = hold_;
  hold_.pressed = false;
  return hold;
}

void PadHand::follow_chords(const PadState& state, const Mapping& mapping, std::int64_t now_ns, bool paused) noexcept {
  action_.reset();
  const auto found = std::ranges::find_if(
      mapping.chords, [&](const Chord& c) { return c.buttons == state.held && (c.buttons & ~released_).none(); });
  const Chord* chord = found == mapping.chords.end() || !neutral() ? nullptr : &*found;
  if (chord != chord_ || paused || (state.pressed & before_).any()) {
    chord_ = chord;
    chord_since_ns_ = now_ns;
    chord_done_ = false;
  }
  if (chord_ == nullptr || chord_done_ || static_cast<double>(now_ns - chord_since_ns_) * 1e-9 < chord_->hold_s) return;
  chord_done_ = true;
  action_ = chord_->action;
}

bool PadHand::neutral() const noexcept {
  return std::ranges::all_of(sticks_, [](double value) { return value == 0.0; });
}

}  // namespace pmg::gamepad
