// (states of game controllers) => a command and requests. One pad drives at a time; any pad stops.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "gamepad/pad_hand.hpp"
#include "operator/command_input.hpp"

namespace pmg::gamepad {

class PadCommand : public ops::CommandInput {
 public:
  explicit PadCommand(Mapping mapping) : mapping_(std::move(mapping)) {}

  /// Every connected pad's state, about every 5 ms. A pad that is missing here is unplugged.
  void take(std::span<const PadReport> pads, std::int64_t now_ns);
  bool stop() const noexcept { return stop_; }  ///< in this step, on any pad
  std::optional<Action> action() const noexcept { return action_; }

  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }
  const Command& command(std::int64_t /*now_ns*/) noexcept override { return command_; }
  bool held() const noexcept override { return driving_.has_value(); }
  bool stays() const noexcept override { return held(); }
  std::int64_t presses() const noexcept override { return presses_; }
  void rest() noexcept override;
  void upright() noexcept override;

  const Mapping& mapping() const noexcept { return mapping_; }
  std::optional<std::int32_t> driving() const noexcept { return driving_; }
  const char* text(std::int32_t pad) const noexcept;  ///< why it doesn't drive, or soon won't; may be empty

 private:
  void choose();
  void follow(const PadHand& hand, double dt_s) noexcept;

  Mapping mapping_;
  CommandLimits limits_;  // zero until they are known: then every command is zero
  std::map<std::int32_t, PadHand> hands_;
  std::optional<std::int32_t> driving_;
  Command command_;
  std::int64_t presses_ = 0, taken_ns_ = 0;
  bool stop_ = false;
  std::optional<Action> action_;
};

}  // namespace pmg::gamepad
