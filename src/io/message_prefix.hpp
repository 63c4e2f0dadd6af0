// A message at the beginning of bytes: a log's event, or a sealed message, whose seal follows it.
#pragma once

#include <cstdint>
#include <exception>
#include <span>

namespace pmg::io {

/// Into a message whose memory is reused. False if the bytes are of another type or cut short, or hold impossible
/// lengths. Safe for foreign bytes.
template <typename Message>
bool decode_prefix(std::span<const std::uint8_t> bytes, Message& message) {
  try {
    return message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) >= 0;
  } catch (const std::exception&) {  // damaged bytes hold a length beyond all memory
    return false;
  }
}

}  // namespace pmg::io
