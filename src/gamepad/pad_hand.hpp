// One game controller in a hand: its deadman button, its chords, and what its sticks ask for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "gamepad/mapping.hpp"
#include "operator/device.hpp"

namespace pmg::gamepad {

/// For one thread. A button that was down when the pad came was not pressed.
class PadHand {
 public:
  explicit PadHand(std::int32_t id) { hold_.id = id; }
  void take(const PadState& state, const Mapping& mapping, std::int64_t now_ns) noexcept;

  ops::Hold take_hold() noexcept;                                    ///< of the deadman; a press is told once
  bool stop() const noexcept { return stop_; }                       ///< pressed in this step
  std::optional<Action> action() const noexcept { return action_; }  ///< a chord whose time is over in this step
  const std::array<double, kStickAxes>& sticks() const noexcept { return sticks_; }  ///< shaped
  bool bends() const noexcept { return bends_; }
  bool upright() const noexcept { return upright_; }
  const char* text() const noexcept { return text_; }  ///< that it is lost, or soon seems to be; may be empty

 private:
  void follow_deadman(const PadState& state, const Mapping& mapping, std::int64_t now_ns) noexcept;
  void follow_chords(const PadState& state, const Mapping& mapping, std::int64_t now_ns, bool paused) noexcept;
  bool neutral() const noexcept;

  std::array<double, kStickAxes> sticks_{};
  Buttons released_;  // seen up since the pad came
  Buttons before_;
  ops::Hold hold_;
  const Chord* chord_ = nullptr;
  std::int64_t chord_since_ns_ = 0, taken_ns_ = -1, changed_ns_ = 0;
  bool stop_ = false, bends_ = false, upright_ = false, chord_done_ = false;
  std::optional<Action> action_;
  const char* text_ = "";
};

}  // namespace pmg::gamepad
