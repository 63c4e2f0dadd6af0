// A message and, behind it in the same datagram, its seal (pmg_msgs::seal_t) or its proof (pmg_msgs::proof_t).
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <optional>
#include <string_view>
#include <vector>

#include "io/lcm_link.hpp"

namespace pmg::seal {

template <typename Message, typename Seal>
struct Sealed {
  Message message{};
  std::optional<Seal> seal;  ///< nothing: the message came alone
  io::Bytes message_bytes;   ///< a part of the bytes that were decoded
};

/// Appends the encoded message.
template <typename Message>
void append(std::vector<std::uint8_t>& bytes, const Message& message) {
  const std::size_t before = bytes.size();
  const int size = message.getEncodedSize();
  bytes.resize(before + static_cast<std::size_t>(size));
  message.encode(bytes.data() + before, 0, size);
}

/// (message, anything) => the message alone; nothing if it is of another type or cut short. Safe for foreign bytes.
template <typename Message, typename Seal>
std::optional<Sealed<Message, Seal>> decode_front(io::Bytes bytes) {
  Sealed<Message, Seal> front;
  try {
    const int used = front.message.decode(bytes.data(), 0, static_cast<int>(bytes.size()));
    if (used <= 0) return std::nullopt;
    front.message_bytes = bytes.first(static_cast<std::size_t>(used));
  } catch (const std::exception&) {  // as in io::decode_message
    return std::nullopt;
  }
  return front;
}

/// (message, seal or nothing) => both; nothing if either is of another type, cut short or too long, or if the seal's
/// bytes are not those that encoding it gives. Safe for foreign bytes.
template <typename Message, typename Seal>
std::optional<Sealed<Message, Seal>> decode_sealed(io::Bytes bytes) {
  std::optional<Sealed<Message, Seal>> sealed = decode_front<Message, Seal>(bytes);
  if (!sealed) return std::nullopt;
  const io::Bytes rest = bytes.subspan(sealed->message_bytes.size());
  if (rest.empty()) return sealed;
  sealed->seal = io::decode_message<Seal>(rest);
  if (!sealed->seal) return std::nullopt;
  std::vector<std::uint8_t> again;
  append(again, *sealed->seal);
  if (!std::ranges::equal(again, rest)) return std::nullopt;
  return sealed;
}

/// The bytes that a code or a signature is computed over: channel, zero byte, message, seal without its code.
template <typename Seal>
std::vector<std::uint8_t> authenticated_bytes(std::string_view channel, io::Bytes message, const Seal& bare_seal) {
  std::vector<std::uint8_t> bytes(channel.begin(), channel.end());
  bytes.push_back(0);
  bytes.insert(bytes.end(), message.begin(), message.end());
  append(bytes, bare_seal);
  return bytes;
}

}  // namespace pmg::seal
