// One CAN frame, classic or FD, and what goes wrong on a bus.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace pmg::can {

struct Frame {
  std::uint32_t id = 0;  ///< 11 bits, 29 with extended
  bool extended = false;
  bool fd = false;  ///< CAN FD with bit rate switch
  std::uint8_t length = 0;
  std::array<std::uint8_t, 64> data{};

  std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(data).first(std::min<std::size_t>(length, 64));
  }
  static Frame of(std::uint32_t id, std::span<const std::uint8_t> bytes, bool fd = false) noexcept {
    Frame frame;
    frame.id = id;
    frame.fd = fd;
    frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 64));
    std::copy_n(bytes.begin(), frame.length, frame.data.begin());
    return frame;
  }
};

/// What the CAN controller of this computer says of its bus.
enum class BusHealth : std::uint8_t {
  kGood,
  kPassive,  ///< error-passive: every frame meets errors, or nobody acknowledges it
  kOff,      ///< bus-off, or the interface is down: nothing is sent
};

}  // namespace pmg::can
