// What the kernel says of a CAN interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace pmg::doctor {

/// Phase of a frame: arbitration, or the data of a CAN FD frame.
struct CanTiming {
  std::uint32_t bitrate = 0;          ///< [bit/s]; 0: unknown
  std::uint32_t sample_permille = 0;  ///< sample point in thousandths of a bit
};

struct CanLink {
  std::string kind;  ///< "can": a controller; "vcan", "slcan" and others have no timing; empty: no CAN interface
  CanTiming arbitration, data;
  std::optional<std::uint32_t> state;  ///< CAN_STATE_... of <linux/can/netlink.h>
  std::uint32_t restart_ms = 0;        ///< 0: a bus that went off stays off
};

/// (an RTM_NEWLINK message, its header included) => what it says of CAN. Nullopt: no such message. Bytes of any kind
/// are taken: lengths are checked.
std::optional<CanLink> parse_can_link(std::span<const std::byte> message) noexcept;

/// Asks the kernel over netlink. Nullopt: error has the error's number (ENODEV: no such interface).
std::optional<CanLink> ask_can_link(const std::string& interface, int& error);

}  // namespace pmg::doctor
