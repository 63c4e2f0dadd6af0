// What a drive and this computer send each other on a bus whose messages have identifiers, as CAN's have.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace pmg::drives {

struct Message {
  std::uint32_t id = 0;  ///< 11 bits, 29 with extended
  bool extended = false;
  bool fd = false;  ///< CAN FD with bit rate switch
  std::uint8_t length = 0;
  std::array<std::uint8_t, 64> data{};

  std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(data).first(std::min<std::size_t>(length, 64));
  }
  static Message of(std::uint32_t id, std::span<const std::uint8_t> bytes, bool fd = false) noexcept {
    Message message;
    message.id = id;
    message.fd = fd;
    message.length = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 64));
    std::copy_n(bytes.begin(), message.length, message.data.begin());
    return message;
  }
};

}  // namespace pmg::drives
