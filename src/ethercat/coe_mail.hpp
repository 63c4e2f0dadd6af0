// CANopen's SDO in a slave's mailbox: CANopen over EtherCAT (ETG.1000.6).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drive_protocols/canopen.hpp"
#include "drives/message.hpp"

namespace pmg::ethercat {

/// A mailbox's message (ETG.1000.4): length (2 bytes), address (2), channel (1), type and counter (1); then CANopen's
/// service in the upper 4 bits of 2 bytes (ETG.1000.6), then an SDO's 8 bytes.
inline constexpr std::size_t kMailBytes = 16;

/// counter: 1 to 7, another one with each message.
std::array<std::uint8_t, kMailBytes> mail_with_sdo(const drives::Message& request, std::uint8_t counter) noexcept;

/// (a mailbox's message) => the SDO's answer in it. Nullopt: it is something else, or too short.
std::optional<drives::canopen::SdoAnswer> sdo_in_mail(std::span<const std::uint8_t> mail) noexcept;

}  // namespace pmg::ethercat
