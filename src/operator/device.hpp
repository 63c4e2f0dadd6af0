// What a person's hands ask a robot for, whatever they hold: keys, a game controller, a headset, a page, or a script. A
// device's class is a mapping: it says what is held and what that asks for. RobotDriver alone decides what is sent.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "operator/arms_source.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg::ops {

/// One thing that must be held for the robot to move: a key, a deadman button, a grip. HoldToDrive judges it.
struct Hold {
  std::int32_t id = 0;   ///< another one for each hand that could drive
  bool down = false;     ///< it is held at this moment
  bool pressed = false;  ///< a press was seen to begin since the last look; none if it was down when the device came
  bool neutral = true;   ///< what it drives by asks for nothing; keys, which do both at once, are always neutral
  bool lost = false;     ///< the device may be out of reach: what it said last no longer counts
  std::int64_t heard_ns = 0;  ///< when the device was last polled or heard
};

/// What a person asks for once, beside the stop.
enum class Request : std::uint8_t {
  kStand,    ///< from any mode, after a stop, too
  kReset,    ///< of a latched fault
  kLimp,     ///< to Passive; a robot that stands brakes first and must be told twice
  kLift,     ///< a simulated robot's hoist
  kSetDown,  ///< likewise
  kWalk,     ///< as kStand, but to Walk; for scripts, whose whole run is one request
  kClaim,    ///< drive the robot in the mode that it has; for scripts
};

struct Requests {
  bool stop = false;  ///< stronger than anything else at the same moment
  std::optional<Request> other{};
};

/// How a kind of device drives, and the words for it.
struct DeviceManner {
  std::string name;     ///< in the source's name: "keyboard"
  bool command_raises;  ///< a command takes the robot from any mode to Walk; otherwise from Stand only
  bool at_once;         ///< a command that changes is sent at once; otherwise the rate is fixed
  std::string raises;   ///< how the robot is made to stand up: "Enter makes it stand up"
  std::string resets;   ///< how a fault is reset: "R resets it"
  std::string drives;   ///< how it is driven from Stand: "a key drives it"
  std::string starts;   ///< the same from a mode below Stand
  std::string lifts = "pmg_send lift lifts it";           ///< how a simulated robot's hoist takes it up
  std::string sets_down = "pmg_send lower sets it down";  ///< likewise
  std::string anew;            ///< what to do after it came to rest by itself: "Press a key anew"
  double timeout_s = 10.0;     ///< for each request
  bool holds_heading = false;  ///< where a simulated robot is asked for no turn, it keeps its heading
};

/// For one thread. All times come from one monotonic clock.
class Device {
 public:
  /// What a far device said counts no more when it travelled this much longer than the device's fastest message.
  static constexpr std::int64_t kLate_ns = 200'000'000;

  Device() = default;
  virtual ~Device() = default;
  Device(const Device&) = default;
  Device& operator=(const Device&) = default;

  virtual DeviceManner manner() const = 0;
  /// Before the limits are known every command should be zero.
  virtual void set_limits(const CommandLimits& limits) noexcept = 0;
  /// What is held at this moment. A press is told once.
  virtual std::span<const Hold> holds(std::int64_t now_ns) noexcept = 0;
  /// The command at this moment. armed: the hold that drives. Without one the velocity has no effect.
  virtual Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept = 0;
  /// Since the last call.
  virtual Requests take_requests() noexcept = 0;
  /// Where the palms shall be; null: the arms are not led. It has effect only while the robot is driven.
  virtual const PerFoot<PalmWish>* palms() const noexcept { return nullptr; }
  virtual void rest() noexcept = 0;     ///< velocity to zero; only a fresh press commands one again
  virtual void upright() noexcept = 0;  ///< posture to neutral
};

}  // namespace pmg::ops
