// The way of Ethernet frames to the first slave and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pmg::ethercat {

inline constexpr std::size_t kMostFrame = 1514;  ///< bytes of an Ethernet frame without its checksum

/// None of these allocates, locks or throws.
class Wire {
 public:
  virtual ~Wire() = default;
  /// False: not sent.
  virtual bool send(std::span<const std::uint8_t> frame) noexcept = 0;
  /// Bytes of the next frame; 0: none within wait_ns.
  virtual std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept = 0;
};

}  // namespace pmg::ethercat
