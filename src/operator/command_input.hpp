// What a person's hands ask a robot for, whatever they hold: keys or a game controller.
#pragma once

#include <cstdint>

#include "pmg/command.hpp"

namespace pmg::ops {

/// For one thread. All times come from one monotonic clock.
class CommandInput {
 public:
  CommandInput() = default;
  virtual ~CommandInput() = default;
  CommandInput(const CommandInput&) = default;
  CommandInput& operator=(const CommandInput&) = default;

  /// Before the limits are known every command is zero.
  virtual void set_limits(const CommandLimits& limits) noexcept = 0;
  /// The command at this moment.
  virtual const Command& command(std::int64_t now_ns) noexcept = 0;
  /// The hands hold something that asks for a command, as far as this knows.
  virtual bool held() const noexcept = 0;
  /// The robot shall stay in Walk although the command is zero.
  virtual bool stays() const noexcept = 0;
  /// Number of times that the hands began to ask for a command.
  virtual std::int64_t presses() const noexcept = 0;
  virtual void rest() noexcept = 0;     ///< velocity to zero; only a fresh press commands one again
  virtual void upright() noexcept = 0;  ///< posture to neutral
};

}  // namespace pmg::ops
