#include "can/canopen.hpp"

#include <array>

namespace pmg::can::canopen {

namespace {

// Command specifiers of expedited transfers with the size indicated: CiA 301, SDO services.
constexpr std::uint8_t kReadRequest = 0x40, kWriteRequest = 0x23, kWriteAnswer = 0x60, kReadAnswer = 0x40,
                       kAbort = 0x80, kSpecifierBits = 0xE0, kExpedited = 0x02, kSized = 0x01;

constexpr std::uint8_t byte(std::uint32_t value, unsigned at) noexcept {
  return static_cast<std::uint8_t>(value >> 8U * at & 0xFFU);
}

/// Low byte first, as CANopen has it.
std::uint32_t number(const Frame& frame, std::size_t at, std::size_t bytes) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(frame.data[at + i]) << 8U * i;
  return value;
}

Frame sdo(int node, std::uint8_t specifier, const drives::ObjectId& id, std::uint32_t value) noexcept {
  const std::array<std::uint8_t, 8> bytes = {specifier,      byte(id.index, 0), byte(id.index, 1), id.subindex,
                                             byte(value, 0), byte(value, 1),    byte(value, 2),    byte(value, 3)};
  return Frame::of(kSdoRequest + static_cast<std::uint32_t>(node), bytes);
}

}  // namespace

Frame node_command(NodeCommand command, int node) noexcept {
  return Frame::of(kNetworkManagement,
                   std::array<std::uint8_t, 2>{static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(node)});
}

Frame sync() noexcept { return Frame::of(kSync, {}); }

Frame heartbeat() noexcept { return Frame::of(kHeartbeat + kHostNode, std::array<std::uint8_t, 1>{kOperational}); }

Frame sdo_read(int node, const drives::ObjectId& id) noexcept { return sdo(node, kReadRequest, id, 0); }

Frame sdo_write(int node, const drives::ObjectId& id, std::uint32_t value) noexcept {
  const std::uint32_t kept = id.bytes >= 4 ? value : value & ((1U << 8U * id.bytes) - 1U);
  return sdo(node, static_cast<std::uint8_t>(kWriteRequest | (4U - id.bytes) << 2U), id, kept);
}

std::optional<SdoAnswer> sdo_answer(const Frame& frame) noexcept {
  if (frame.extended || frame.length != 8) return std::nullopt;
  SdoAnswer answer{.id = {.index = static_cast<std::uint16_t>(number(frame, 1, 2)), .subindex = frame.data[3]}};
  const std::uint8_t specifier = frame.data[0] & kSpecifierBits;
  answer.aborted = specifier == kAbort;
  answer.upload = specifier == kReadAnswer;
  if (!answer.aborted && !answer.upload && specifier != kWriteAnswer) return std::nullopt;
  if (answer.upload) {
    answer.expedited = (frame.data[0] & kExpedited) != 0;
    const bool sized = (frame.data[0] & kSized) != 0;
    answer.id.bytes = static_cast<std::uint8_t>(sized ? 4 - (frame.data[0] >> 2U & 3U) : 4);
  }
  answer.value = number(frame, 4, answer.upload ? answer.id.bytes : 4);
  return answer;
}

Frame targets_frame(int node, const drives::Cia402Targets& targets) noexcept {
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
  return Frame::of(kReceive1 + static_cast<std::uint32_t>(node), bytes);
}

bool take_transmit1(const Frame& frame, drives::Cia402Inputs& inputs) noexcept {
  if (frame.length != 8) return false;
  inputs.status_word = static_cast<std::uint16_t>(number(frame, 0, 2));
  inputs.position = static_cast<std::int32_t>(number(frame, 2, 4));
  inputs.torque = static_cast<std::int16_t>(number(frame, 6, 2));
  return true;
}

bool take_transmit2(const Frame& frame, drives::Cia402Inputs& inputs) noexcept {
  if (frame.length != 6 && frame.length != 8) return false;
  inputs.velocity = static_cast<std::int32_t>(number(frame, 0, 4));
  inputs.error_code = static_cast<std::uint16_t>(number(frame, 4, 2));
  if (frame.length == 8) inputs.temperature = static_cast<std::int16_t>(number(frame, 6, 2));
  return true;
}

}  // namespace pmg::can::canopen
