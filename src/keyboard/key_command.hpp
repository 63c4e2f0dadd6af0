// The mapping of keys: (pressed keys) => velocities while they are held, postures that stay, requests. Independent of
// terminals and windows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "operator/device.hpp"

namespace pmg::ops {

enum class Key : std::uint8_t {
  kForwards,
  kBackwards,
  kTurnLeft,
  kTurnRight,
  kStepLeft,
  kStepRight,  // the last key that moves the robot
  kSquat,
  kRise,
  kBendForwards,
  kBendBack,
  kLeanLeft,
  kLeanRight,
  kUpright,  ///< posture back to neutral; the last key that is a command
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

/// The key events that the program gets. They decide when a robot must stop.
enum class KeyReport {
  kPressAndRelease,  ///< a window: a key commands a velocity while it is held down
  kPressOnly,  ///< a terminal: each press changes the velocity by a step; after a second without a press it is zero
};

class KeyCommand : public Device {
 public:
  static constexpr double kShare = 0.5;           ///< of the robot's range; with Shift the whole range
  static constexpr double kVelocityStep = 0.125;  ///< share of the range's larger end, for each press in a terminal
  static constexpr double kHeightStep_m = 0.02, kAngleStep_rad = 0.05;
  static constexpr std::int64_t kSilence_ns = 1'000'000'000;  ///< in a terminal: time without any key
  /// If a held key repeated and then stops repeating without a release, its release was lost. Keyboards repeat 10 to 40
  /// times a second.
  static constexpr std::int64_t kRepeatLost_ns = 400'000'000;
  /// Only the last key repeats. A key without proof that it is still held counts as released this long after the last
  /// event of any key.
  static constexpr std::int64_t kUnconfirmed_ns = 10'000'000'000;

  explicit KeyCommand(KeyReport report) : report_(report) {}

  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }

  /// Keys by the names of key_named(). Others have no meaning, but keep a held key from repeating.
  void press(std::string_view name, bool fast, std::int64_t now_ns) noexcept;
  void repeat(std::string_view name, bool fast, std::int64_t now_ns) noexcept;
  void release(std::string_view name, std::int64_t now_ns) noexcept;

  void press(Key key, bool fast, std::int64_t now_ns) noexcept;
  void repeat(Key key, bool fast, std::int64_t now_ns) noexcept;  ///< of a held key
  void press_other() noexcept { newest_.reset(); }                ///< of a key without meaning
  void release(Key key, std::int64_t now_ns) noexcept;
  void release_all() noexcept;                                          ///< the window has lost the keyboard
  void listen(std::int64_t now_ns) noexcept { listened_ns_ = now_ns; }  ///< the window has polled its keys
  void rest() noexcept override;
  void upright() noexcept override;

  DeviceManner manner() const override;
  /// Releases keys whose time is over (kRepeatLost_ns, kUnconfirmed_ns).
  std::span<const Hold> holds(std::int64_t now_ns) noexcept override;
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  Requests take_requests() noexcept override;

 private:
  struct Held {
    bool down = false, fast = false, repeats = false;
    std::int64_t seen_ns = 0;
  };

  void bend(Key key) noexcept;
  void change_velocity(Key key, bool fast) noexcept;
  void forget_lost(std::int64_t now_ns) noexcept;
  double end_of_range(Channel channel, double direction, bool fast) const noexcept;

  bool held() const noexcept;
  void zero() noexcept;

  KeyReport report_;
  CommandLimits limits_;  // zero until they are known: then every command is zero
  std::array<Held, kKeys> held_{};
  std::optional<Key> newest_;
  Command command_;
  Hold
      hold_;  // all keys together; in a terminal a press holds it until rest(), since nobody knows when a key is let go
  Hold shown_;  // hold_ as the last look saw it
  Requests requests_;
  std::int64_t pressed_ns_ = 0, stepped_ns_ = 0, listened_ns_ = 0, sign_ns_ = 0;
};

}  // namespace pmg::ops
