// One game controller in a hand: its deadman, its chords, and what its sticks ask for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "gamepad/mapping.hpp"

namespace pmg::gamepad {

/// For one thread. The deadman arms by a press that was seen to begin while the sticks were neutral, and by nothing
/// else: not by a button that was down when the pad came, nor by one that was down when the pad was disarmed.
class PadHand {
 public:
  static constexpr std::int64_t kDeaf_ns = 300'000'000;  ///< a program that paused so long must not drive on

  void take(const PadState& state, const Mapping& mapping, std::int64_t now_ns) noexcept;
  void disarm() noexcept { armed_ = false; }

  bool armed() const noexcept { return armed_; }
  bool stop() const noexcept { return stop_; }
  std::optional<Action> action() const noexcept { return action_; }  ///< a chord whose time is over in this step
  const std::array<double, kStickAxes>& sticks() const noexcept { return sticks_; }  ///< shaped
  bool bends() const noexcept { return bends_; }
  bool upright() const noexcept { return upright_; }
  const char* text() const noexcept { return text_; }  ///< why the deadman isn't armed, or soon won't be; may be empty

 private:
  void follow_deadman(const PadState& state, const Mapping& mapping, std::int64_t now_ns, bool paused) noexcept;
  void follow_chords(const PadState& state, const Mapping& mapping, std::int64_t now_ns, bool paused) noexcept;
  bool neutral() const noexcept;

  std::array<double, kStickAxes> sticks_{};
  Buttons released_;  // seen up since the pad came
  Buttons before_;
  const Chord* chord_ = nullptr;
  std::int64_t chord_since_ns_ = 0, taken_ns_ = -1, changed_ns_ = 0;
  bool armed_ = false, stop_ = false, bends_ = false, upright_ = false, chord_done_ = false;
  std::optional<Action> action_;
  const char* text_ = "";
};

}  // namespace pmg::gamepad
