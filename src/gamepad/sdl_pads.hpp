// The game controllers of this computer, read through SDL2. The only file that knows SDL.
#pragma once

#include <map>
#include <vector>

#include "gamepad/pad_text.hpp"

struct _SDL_GameController;  // NOLINT(bugprone-reserved-identifier): SDL's own name
union SDL_Event;

namespace pmg::gamepad {

/// One at a time in a process, for one thread.
class SdlPads {
 public:
  SdlPads();  ///< throws std::runtime_error if SDL doesn't start
  ~SdlPads();
  SdlPads(const SdlPads&) = delete;
  SdlPads& operator=(const SdlPads&) = delete;

  /// Reads what came, without waiting. Valid until the next call.
  const std::vector<PadReport>& poll();
  /// What is plugged in and can't be used.
  std::vector<UselessPad> useless() const;
  /// Light and rumble of every pad that has them. Rumbles once when a fault, a limit or a lost link begins.
  void show(Sign sign);

 private:
  void take(const SDL_Event& event);
  void open(int index);
  void refuse(int index, std::string why, std::string remedy);

  std::map<std::int32_t, _SDL_GameController*> open_;
  std::map<std::int32_t, PadReport> pads_;
  std::map<std::int32_t, UselessPad> useless_;
  std::vector<PadReport> reports_;
  Sign shown_ = Sign::kRest;
};

}  // namespace pmg::gamepad
