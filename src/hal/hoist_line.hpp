// Flags between the thread that hears operators and a hoist that carries the robot.
#pragma once

#include <atomic>
#include <cstdint>

namespace pmg::hal {

/// What the hoist does; the numbers are those of pmg_msgs::hoist_state_t.
enum class CraneState : std::uint8_t {
  kFree = 0,       ///< straps off: the robot is on its own
  kCatching = 1,   ///< straps are tightened, from where the torso is on the way up
  kLifting = 2,    ///< up, and upright
  kHolding = 3,    ///< feet clear of the ground
  kLowering = 4,   ///< down, then slack
  kLettingGo = 5,  ///< straps are loosened
};

/// Wait-free. The operators' thread calls ask() and see(); the bus thread calls stays_up(), stands() and show().
class HoistLine {
 public:
  /// Up, and stay there; or down as soon as the robot stands.
  void ask(bool up) noexcept { stays_up_.store(up, std::memory_order_relaxed); }
  /// The controller's newest tick. upright: in Stand or Walk. entering: the ramp into Stand isn't over. Standing up
  /// anew ends a wish to stay up.
  void see(bool upright, bool entering) noexcept {
    if (upright && !upright_) ask(false);
    upright_ = upright;
    stands_.store(upright && !entering, std::memory_order_relaxed);
  }
  CraneState state() const noexcept { return state_.load(std::memory_order_relaxed); }

  bool stays_up() const noexcept { return stays_up_.load(std::memory_order_relaxed); }
  bool stands() const noexcept { return stands_.load(std::memory_order_relaxed); }
  void show(CraneState state) noexcept { state_.store(state, std::memory_order_relaxed); }

 private:
  std::atomic<bool> stays_up_{false}, stands_{false};
  std::atomic<CraneState> state_{CraneState::kHolding};
  bool upright_ = false;  // the operators' thread's
};

}  // namespace pmg::hal
