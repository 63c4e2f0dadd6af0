#include "drive_protocols/canopen.hpp"

#include <array>

namespace pmg::drives::canopen {

namespace {

// Command specifiers of expedited transfers with the size indicated: CiA 301, SDO services.
constexpr std::uint8_t kReadRequest = 0x40, kWriteRequest = 0x23, kWriteAnswer = 0x60, kReadAnswer = 0x40,
                       kAbort = 0x80, kSpecifierBits = 0xE0, kExpedited = 0x02, kSized = 0x01;

constexpr std::uint8_t byte(std::uint32_t value, unsigned at) noexcept {
  return static_cast<std::uint8_t>(value >> 8U * at & 0xFFU);
}

/// Low byte first, as CANopen has it.
std::uint32_t number(const Message& message, std::size_t at, std::size_t bytes) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(message.data[at + i]) << 8U * i;
  return value;
}

Message sdo(int node, std::uint8_t specifier, const ObjectId& id, std::uint32_t value) noexcept {
  const std::array<std::uint8_t, 8> bytes = {specifier,      byte(id.index, 0), byte(id.index, 1), id.subindex,
                                             byte(value, 0), byte(value, 1),    byte(value, 2),    byte(value, 3)};
  return Message::of(kSdoRequest + static_cast<std::uint32_t>(node), bytes);
}

}  // namespace

std::optional<int> sender(const Message& message) noexcept {
  const int node = static_cast<int>(message.id & kNodeBits);
  const std::uint32_t function = message.id & ~kNodeBits;
  const bool cyclic =
      function == kTransmit1 || function == kTransmit2 || function == kEmergency || function == kHeartbeat;
  return message.extended || !cyclic || node == 0 ? std::nullopt : std::optional<int>(node);
}

Message node_command(NodeCommand command, int node) noexcept {
  return Message::of(kNetworkManagement,
                     std::array<std::uint8_t, 2>{static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(node)});
}

Message sync() noexcept { return Message::of(kSync, {}); }

Message heartbeat() noexcept { return Message::of(kHeartbeat + kHostNode, std::array<std::uint8_t, 1>{kOperational}); }

Message sdo_read(int node, const ObjectId& id) noexcept { return sdo(node, kReadRequest, id, 0); }

Message sdo_write(int node, const ObjectId& id, std::uint32_t value) noexcept {
  const std::uint32_t kept = id.bytes >= 4 ? value : value & ((1U << 8U * id.bytes) - 1U);
  return sdo(node, static_cast<std::uint8_t>(kWriteRequest | (4U - id.bytes) << 2U), id, kept);
}

std::optional<SdoAnswer> sdo_answer(const Message& message) noexcept {
  if (message.extended || message.length != 8) return std::nullopt;
  SdoAnswer answer{.id = {.index = static_cast<std::uint16_t>(number(message, 1, 2)), .subindex = message.data[3]}};
  const std::uint8_t specifier = message.data[0] & kSpecifierBits;
  answer.aborted = specifier == kAbort;
  answer.upload = specifier == kReadAnswer;
  if (!answer.aborted && !answer.upload && specifier != kWriteAnswer) return std::nullopt;
  if (answer.upload) {
    answer.expedited = (message.data[0] & kExpedited) != 0;
    const bool sized = (message.data[0] & kSized) != 0;
    answer.id.bytes = static_cast<std::uint8_t>(sized ? 4 - (message.data[0] >> 2U & 3U) : 4);
  }
  answer.value = number(message, 4, answer.upload ? answer.id.bytes : 4);
  return answer;
}

Message targets_frame(int node, const Cia402Targets& targets) noexcept {
  const auto position = static_cast<std::uint32_t>(targets.position);
  const auto torque = static_cast<std::uint16_t>(targets.torque);
  const std::array<std::uint8_t, 8> bytes = {byte(targets.control_word, 0),
                                             byte(targets.control_word, 1),
                                             byte(position, 0),
                                             byte(position, 1),
                                             byte(position, 2),
                                             byte(position, 3),
                                             byte(torque, 0),
                                             byte(torque, 1)};
  return Message::of(kReceive1 + static_cast<std::uint32_t>(node), bytes);
}

bool take_transmit1(const Message& message, Cia402Inputs& inputs) noexcept {
  if (message.length != 8) return false;
  inputs.status_word = static_cast<std::uint16_t>(number(message, 0, 2));
  inputs.position = static_cast<std::int32_t>(number(message, 2, 4));
  inputs.torque = static_cast<std::int16_t>(number(message, 6, 2));
  return true;
}

bool take_transmit2(const Message& message, Cia402Inputs& inputs) noexcept {
  if (message.length != 6 && message.length != 8) return false;
  inputs.velocity = static_cast<std::int32_t>(number(message, 0, 4));
  inputs.error_code = static_cast<std::uint16_t>(number(message, 4, 2));
  if (message.length == 8) inputs.temperature = static_cast<std::int16_t>(number(message, 6, 2));
  return true;
}

}  // namespace pmg::drives::canopen
