#include "operator/joined_devices.hpp"

namespace pmg::ops {

void JoinedDevices::set_limits(const CommandLimits& limits) noexcept {
  for (Device* device : devices_) device->set_limits(limits);
}

std::span<const Hold> JoinedDevices::holds(std::int64_t now_ns) noexcept {
  holds_.clear();
  owners_.clear();
  for (Device* device : devices_) {
    for (const Hold& hold : device->holds(now_ns)) {
      holds_.push_back(hold);
      owners_.push_back(device);
    }
  }
  return holds_;
}

Command JoinedDevices::command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept {
  Device* owner = nullptr;
  for (std::size_t i = 0; i < holds_.size(); ++i)
    if (armed == holds_[i].id) owner = owners_[i];
  driving_ = owner != nullptr;
  if (driving_ && owner != driver_) {
    for (Device* device : devices_)
      if (device != owner) device->upright();
    driver_ = owner;
  }
  Command command;
  for (Device* device : devices_) {
    const Command own = device->command(device == owner ? armed : std::nullopt, now_ns);
    if (device == driver_) command = own;
  }
  return command;
}

Requests JoinedDevices::take_requests() noexcept {
  Requests joined;
  for (Device* device : devices_) {
    const Requests requests = device->take_requests();
    joined.stop = joined.stop || requests.stop;
    if (!joined.other) joined.other = requests.other;
  }
  return joined;
}

const PerFoot<PalmWish>* JoinedDevices::palms() const noexcept { return driving_ ? driver_->palms() : nullptr; }

void JoinedDevices::rest() noexcept {
  driving_ = false;
  for (Device* device : devices_) device->rest();
}

void JoinedDevices::upright() noexcept {
  for (Device* device : devices_) device->upright();
}

}  // namespace pmg::ops
