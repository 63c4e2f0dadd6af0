// The mapping of game controllers: (their states) => a command and requests. One pad drives at a time; any pad stops.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "gamepad/pad_hand.hpp"
#include "operator/device.hpp"

namespace pmg::gamepad {

class PadCommand : public ops::Device {
 public:
  explicit PadCommand(Mapping mapping) : mapping_(std::move(mapping)) {}

  /// Every connected pad's state, about every 5 ms. A pad that is missing here is unplugged. One without the stop
  /// button drives nothing.
  void take(std::span<const PadReport> pads, std::int64_t now_ns);

  ops::DeviceManner manner() const override;
  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }
  std::span<const ops::Hold> holds(std::int64_t now_ns) noexcept override;  ///< one for each pad, with its id
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  ops::Requests take_requests() noexcept override;
  void rest() noexcept override;
  void upright() noexcept override;

  const Mapping& mapping() const noexcept { return mapping_; }
  const char* text(std::int32_t pad) const noexcept;  ///< that it is lost, or soon seems to be; may be empty

 private:
  void follow(const PadHand& hand, double dt_s) noexcept;

  Mapping mapping_;
  CommandLimits limits_;  // zero until they are known: then every command is zero
  std::map<std::int32_t, PadHand> hands_;
  std::vector<ops::Hold> holds_;
  std::optional<std::int32_t> driving_;
  Command command_;
  ops::Requests requests_;
  std::int64_t commanded_ns_ = 0;
};

}  // namespace pmg::gamepad
