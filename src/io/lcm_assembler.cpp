#include "io/lcm_assembler.hpp"

#include <algorithm>
#include <utility>

namespace pmg::io {

namespace {

constexpr std::uint32_t kShort = 0x4c433032, kFragment = 0x4c433033;  // "LC02", "LC03"
constexpr std::size_t kShortHeader = 8, kFragmentHeader = 20;

/// bytes has at least `at` and 4 more.
std::uint32_t number_at(Bytes bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(at, 4)) value = value << 8 | byte;
  return value;
}
std::uint16_t half_at(Bytes bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

/// (name, zero byte, rest) => (name); nothing if no zero byte comes within the bytes and LCM's longest name.
std::optional<std::string_view> name_at_front(Bytes bytes) noexcept {
  const Bytes searched = bytes.first(std::min(bytes.size(), LcmAssembler::kLongestChannel + 1));
  const auto end = std::ranges::find(searched, std::uint8_t{0});
  if (end == searched.end()) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - searched.begin());
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), length);
}

}  // namespace

LcmAssembler::LcmAssembler() {
  for (Place& place : places_) place.bytes.resize(kLargestMessage);
}

std::size_t LcmAssembler::want(std::string channel) {
  channels_.push_back(std::move(channel));
  return channels_.size() - 1;
}

std::optional<LcmMessage> LcmAssembler::take(std::uint64_t sender, Bytes datagram) noexcept {
  if (datagram.size() >= kShortHeader && number_at(datagram, 0) == kShort) {
    return take_short(datagram.subspan(kShortHeader));
  }
  if (datagram.size() >= kFragmentHeader && number_at(datagram, 0) == kFragment) return take_fragment(sender, datagram);
  ++counts_.malformed;
  return std::nullopt;
}

std::optional<LcmMessage> LcmAssembler::take_short(Bytes rest) noexcept {
  const auto name = name_at_front(rest);
  const auto channel = name ? find_channel(*name) : std::nullopt;
  if (!channel) {
    ++(name ? counts_.unwanted : counts_.malformed);
    return std::nullopt;
  }
  ++counts_.messages;
  return LcmMessage{*channel, rest.subspan(name->size() + 1)};
}

std::optional<LcmMessage> LcmAssembler::take_fragment(std::uint64_t sender, Bytes datagram) noexcept {
  const std::uint32_t number = number_at(datagram, 4);
  const std::size_t size = number_at(datagram, 8), offset = number_at(datagram, 12);
  const std::uint16_t index = half_at(datagram, 16), count = half_at(datagram, 18);
  Bytes part = datagram.subspan(kFragmentHeader);
  if (index >= count || offset > size) {
    ++counts_.malformed;
    return std::nullopt;
  }
  Place* place = place_of(sender);
  if (place != nullptr && place->number == number && index < place->next && repeats(*place, offset, index, part)) {
    ++counts_.unwanted;
    return std::nullopt;
  }
  if (index == 0) {
    if (place != nullptr) drop(*place);  // the sender has begun its next message
    const auto name = name_at_front(part);
    const auto channel = name ? find_channel(*name) : std::nullopt;
    if (!channel || size > kLargestMessage) {
      ++(name ? counts_.unwanted : counts_.malformed);
      return std::nullopt;
    }
    part = part.subspan(name->size() + 1);
    place = &begin(sender);
    place->number = number;
    place->size = size;
    place->count = count;
    place->channel = *channel;
  }
  if (place == nullptr || place->number != number) {
    ++counts_.unwanted;
    return std::nullopt;
  }
  const bool continues =
      size == place->size && count == place->count && index == place->next && offset == place->filled;
  if (!continues || part.size() > place->size - place->filled) {  // filled never exceeds size
    ++counts_.malformed;
    drop(*place);
    return std::nullopt;
  }
  std::ranges::copy(part, place->bytes.begin() + static_cast<std::ptrdiff_t>(place->filled));
  place->filled += part.size();
  ++place->next;
  ++counts_.fragments;
  if (place->next < place->count) return std::nullopt;
  if (place->filled != place->size) {
    drop(*place);
    return std::nullopt;
  }
  place->used = false;
  --counts_.fragments;
  ++counts_.messages;
  return LcmMessage{place->channel, Bytes(place->bytes).first(place->size)};
}

bool LcmAssembler::repeats(const Place& place, std::size_t offset, std::uint16_t index, Bytes part) noexcept {
  if (index == 0) {
    const auto name = name_at_front(part);
    if (!name) return false;
    part = part.subspan(name->size() + 1);
  }
  if (offset > place.filled || part.size() > place.filled - offset) return false;
  return std::ranges::equal(part, Bytes(place.bytes).subspan(offset, part.size()));
}

std::optional<std::size_t> LcmAssembler::find_channel(std::string_view name) const noexcept {
  const auto found = std::ranges::find(channels_, name);
  if (found == channels_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels_.begin());
}

LcmAssembler::Place* LcmAssembler::place_of(std::uint64_t sender) noexcept {
  const auto found =
      std::ranges::find_if(places_, [&](const Place& place) { return place.used && place.sender == sender; });
  return found == places_.end() ? nullptr : &*found;
}

LcmAssembler::Place& LcmAssembler::begin(std::uint64_t sender) noexcept {
  Place& place = *std::ranges::min_element(
      places_, {}, [](const Place& candidate) { return candidate.used ? candidate.begun : std::int64_t{-1}; });
  if (place.used) drop(place);
  place.used = true;
  place.sender = sender;
  place.filled = 0;
  place.next = 0;
  place.begun = begun_++;
  return place;
}

void LcmAssembler::drop(Place& place) noexcept {
  place.used = false;
  ++counts_.incomplete;
}

}  // namespace pmg::io
