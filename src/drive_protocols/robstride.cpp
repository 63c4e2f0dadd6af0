#include "drive_protocols/robstride.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::drives {

namespace {
constexpr double kDegree = 0.1;  // of a count of temperature [degC]

/// A drive gives it to whoever asks for faults: bytes 1 and 2 are bits of faults, the others zero. As a reading it
/// would be full speed and full torque at 0 degC.
bool fault_message(std::span<const std::uint8_t> bytes) noexcept {
  return std::ranges::all_of(bytes.subspan(3), [](std::uint8_t byte) { return byte == 0; });
}
}  // namespace

std::optional<MitReply> RobstrideDrive::read(std::span<const std::uint8_t> bytes) const noexcept {
  auto reply = codec().reply(bytes);
  if (!reply || fault_message(bytes)) return std::nullopt;
  reply->reading.temperature_degC = kDegree * (bytes[6] << 8U | bytes[7]);
  reply->reading.fault = DriveFault::kNone;
  return reply;
}

Message RobstrideDrive::reply(const MitReply& reply) const noexcept {
  Message message = MitDrive::reply(reply);
  const auto count =
      static_cast<std::uint16_t>(std::lround(std::clamp(reply.reading.temperature_degC / kDegree, 0.0, 65535.0)));
  message.data[6] = static_cast<std::uint8_t>(count >> 8U);
  message.data[7] = static_cast<std::uint8_t>(count);
  return message;
}

}  // namespace pmg::drives
