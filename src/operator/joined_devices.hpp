// Several devices of one program as one: a page and a headset that share a server.
#pragma once

#include <optional>
#include <vector>

#include "operator/device.hpp"

namespace pmg::ops {

/// Whoever's hold is armed commands; everybody's stop counts. The ids of their holds must differ. Where nothing is
/// armed, the posture of the device that drove last stays; when another one begins to drive, the others go to neutral.
class JoinedDevices : public Device {
 public:
  /// Keeps the pointers; at least one.
  JoinedDevices(std::vector<Device*> devices, DeviceManner manner)
      : devices_(std::move(devices)), manner_(std::move(manner)) {}

  DeviceManner manner() const override { return manner_; }
  void set_limits(const CommandLimits& limits) noexcept override;
  std::span<const Hold> holds(std::int64_t now_ns) noexcept override;
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  Requests take_requests() noexcept override;  ///< of several at one moment the first device's
  const PerFoot<PalmWish>* palms() const noexcept override;
  void rest() noexcept override;
  void upright() noexcept override;

 private:
  std::vector<Device*> devices_;
  DeviceManner manner_;
  std::vector<Hold> holds_;
  std::vector<Device*> owners_;  // of holds_
  Device* driver_ = nullptr;     // the one that drives, or drove last
  bool driving_ = false;
};

}  // namespace pmg::ops
