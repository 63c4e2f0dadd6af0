#include "drive_protocols/mini_cheetah.hpp"

#include <algorithm>

namespace pmg::drives {

namespace {
constexpr std::size_t kReplyBytes = 6;
}

std::optional<MitReply> MiniCheetahDrive::read(std::span<const std::uint8_t> bytes) const noexcept {
  if (bytes.size() != kReplyBytes && bytes.size() != kReplyBytes + 1) return std::nullopt;
  MitFrame whole{};
  std::copy_n(bytes.begin(), kReplyBytes, whole.begin());
  auto reply = codec().reply(whole);
  reply->reading.temperature_degC = 0.0;
  reply->reading.fault = DriveFault::kNone;
  return reply;
}

Message MiniCheetahDrive::reply(const MitReply& reply) const noexcept {
  Message message = MitDrive::reply(reply);
  message.length = kReplyBytes;
  message.data[6] = message.data[7] = 0;
  return message;
}

}  // namespace pmg::drives
