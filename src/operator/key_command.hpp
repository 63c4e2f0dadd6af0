// What pressed keys ask of a robot: velocities with a deadman, postures that stay. No terminal and no window here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pmg/command.hpp"

namespace pmg::ops {

enum class Key : std::uint8_t {
  kForwards,
  kBackwards,
  kTurnLeft,
  kTurnRight,
  kStepLeft,
  kStepRight,  // the last one that moves
  kSquat,
  kRise,
  kBendForwards,
  kBendBack,
  kLeanLeft,
  kLeanRight,
  kUpright,  ///< posture back to neutral; the last one that is a command
  kRest,     ///< velocity to zero
  kDamp,
  kStand,
  kReset,
  kLift,
  kSetDown,
};
inline constexpr std::size_t kKeys = 19;

/// The key with this name: a lower-case letter, "space", "escape", "backspace", "enter", "up", "down", "left", "right".
std::optional<Key> key_named(std::string_view name) noexcept;

/// What is known of keys, which decides what keeps a robot moving.
enum class KeyReport {
  kPressAndRelease,  ///< a window: a key that is held down asks for a velocity, for as long as it is
  kPressOnly,        ///< a terminal: each press changes the velocity by a step, and a second without any ends it
};

/// For one thread; times are of any one clock that never runs backwards.
class KeyCommand {
 public:
  static constexpr double kShare = 0.5;           ///< of the robot's range, with Shift all of it
  static constexpr double kVelocityStep = 0.125;  ///< of the larger of a range's ends, each press in a terminal
  static constexpr double kHeightStep_m = 0.02, kAngleStep_rad = 0.05;
  static constexpr std::int64_t kSilence_ns = 1'000'000'000;  ///< in a terminal: without any key
  /// A key that repeats by itself and stops to do so without being let go: its release was lost. Keyboards repeat
  /// 10 to 40 times a second.
  static constexpr std::int64_t kRepeatLost_ns = 400'000'000;
  /// Only the last key repeats. One that can't show that it is still held counts as let go so long after the last sign
  /// of any key.
  static constexpr std::int64_t kUnconfirmed_ns = 10'000'000'000;
  static constexpr std::int64_t kDeaf_ns = 300'000'000;  ///< a window that doesn't look at keys for so long hears none

  explicit KeyCommand(KeyReport report) : report_(report) {}

  void set_limits(const CommandLimits& limits) noexcept { limits_ = limits; }

  void press(Key key, bool fast, std::int64_t now_ns) noexcept;
  void repeat(Key key, bool fast, std::int64_t now_ns) noexcept;  ///< of a key that is held
  void press_other() noexcept { newest_.reset(); }                ///< of a key that means nothing
  void release(Key key, std::int64_t now_ns) noexcept;
  void release_all() noexcept;                                          ///< the window is no longer listened to
  void listen(std::int64_t now_ns) noexcept { listened_ns_ = now_ns; }  ///< a window looked at its keys
  void rest() noexcept;     ///< velocity to zero; keys that are held must be pressed anew
  void upright() noexcept;  ///< posture to neutral

  /// Looks at the clock: what was lost or left alone counts as let go.
  const Command& command(std::int64_t now_ns) noexcept;
  /// Presses of keys that command something, repetitions aside.
  std::int64_t presses() const noexcept { return presses_; }

 private:
  struct Held {
    bool down = false, fast = false, repeats = false;
    std::int64_t seen_ns = 0;
  };

  void bend(Key key) noexcept;
  void change_velocity(Key key, bool fast) noexcept;
  void forget_lost(std::int64_t now_ns) noexcept;
  double end_of_range(Channel channel, double direction, bool fast) const noexcept;

  KeyReport report_;
  CommandLimits limits_;  // zero until they are known: nothing can be asked for
  std::array<Held, kKeys> held_{};
  std::optional<Key> newest_;
  Command command_;
  std::int64_t presses_ = 0, pressed_ns_ = 0, stepped_ns_ = 0, listened_ns_ = 0, sign_ns_ = 0;
};

}  // namespace pmg::ops
