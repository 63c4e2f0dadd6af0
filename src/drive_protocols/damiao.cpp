#include "drive_protocols/damiao.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace pmg::drives {

namespace {

constexpr std::uint8_t kDisabled = 0x0, kEnabled = 0x1;
constexpr std::array<std::pair<std::uint8_t, DriveFault>, 7> kFaults = {{{0x8, DriveFault::kOverVoltage},
                                                                         {0x9, DriveFault::kUnderVoltage},
                                                                         {0xA, DriveFault::kOverCurrent},
                                                                         {0xB, DriveFault::kBridgeTemperature},
                                                                         {0xC, DriveFault::kOverTemperature},
                                                                         {0xD, DriveFault::kCommunication},
                                                                         {0xE, DriveFault::kOverload}}};
constexpr std::uint8_t kUnknownFault = 0xF;

DriveFault fault_of(std::uint8_t state) noexcept {
  if (state == kDisabled || state == kEnabled) return DriveFault::kNone;
  const auto known = std::ranges::find(kFaults, state, &std::pair<std::uint8_t, DriveFault>::first);
  return known == kFaults.end() ? DriveFault::kOther : known->second;
}

std::uint8_t state_of(const MotorReading& reading) noexcept {
  if (reading.fault == DriveFault::kNone) return reading.follows == Follows::kYes ? kEnabled : kDisabled;
  const auto known = std::ranges::find(kFaults, reading.fault, &std::pair<std::uint8_t, DriveFault>::second);
  return known == kFaults.end() ? kUnknownFault : known->first;
}

}  // namespace

std::optional<MitReply> DamiaoDrive::read(std::span<const std::uint8_t> bytes) const noexcept {
  auto reply = codec().reply(bytes);
  if (!reply) return std::nullopt;
  const auto state = static_cast<std::uint8_t>(bytes[0] >> 4U);
  reply->node = bytes[0] & 0x0FU;
  reply->reading.temperature_degC = std::max(bytes[6], bytes[7]);
  reply->reading.fault = fault_of(state);
  reply->reading.follows = state == kEnabled ? Follows::kYes : Follows::kNo;
  return reply;
}

Message DamiaoDrive::reply(const MitReply& reply) const noexcept {
  Message message = MitDrive::reply(reply);
  const auto temperature = static_cast<std::uint8_t>(std::clamp(reply.reading.temperature_degC, 0.0, 255.0));
  message.data[0] = static_cast<std::uint8_t>(state_of(reply.reading) << 4U | (reply.node & 0x0FU));
  message.data[6] = message.data[7] = temperature;
  return message;
}

}  // namespace pmg::drives
