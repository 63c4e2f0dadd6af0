#include "can/candump.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

namespace pmg::can {

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000, kNsPerUs = 1'000;
constexpr std::uint8_t kBitRateSwitch = 1;
constexpr std::uint32_t kErrorFlag = 0x20000000U;  // CAN_ERR_FLAG
using Kind = RecordedFrame::Kind;

/// The number at the text's beginning, which is cut off; nullopt: none of exactly so many characters (0: of any).
std::optional<std::uint64_t> take_number(std::string_view& text, int base, std::size_t characters = 0) {
  std::uint64_t value = 0;
  const std::string_view digits = characters == 0 ? text : text.substr(0, characters);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  const auto count = static_cast<std::size_t>(end - digits.data());
  if (error != std::errc() || (characters != 0 && count != characters)) return std::nullopt;
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, std::string_view what) {
  if (!text.starts_with(what)) return false;
  text.remove_prefix(what.size());
  return true;
}

}  // namespace

std::string to_line(const RecordedFrame& recorded) {
  const drives::Message& frame = recorded.frame;
  std::string text = fmt::format("({}.{:06}) {} ", recorded.stamp_ns / kNsPerS, recorded.stamp_ns % kNsPerS / kNsPerUs,
                                 recorded.interface);
  if (recorded.kind == Kind::kError) {
    text += fmt::format("{:08X}", frame.id | kErrorFlag);
  } else {
    text += frame.extended ? fmt::format("{:08X}", frame.id) : fmt::format("{:03X}", frame.id);
  }
  if (recorded.kind == Kind::kRemote) return text + (frame.length > 0 ? fmt::format("#R{}", frame.length) : "#R");
  text += frame.fd ? fmt::format("##{:X}", kBitRateSwitch) : "#";
  for (const std::uint8_t byte : frame.bytes()) text += fmt::format("{:02X}", byte);
  return text;
}

std::optional<RecordedFrame> from_line(std::string_view line) {
  RecordedFrame recorded;
  if (!take(line, "(")) return std::nullopt;
  const auto seconds = take_number(line, 10);
  if (!seconds || *seconds > 1ULL << 33U || !take(line, ".")) return std::nullopt;
  const auto micros = take_number(line, 10, 6);
  if (!micros || !take(line, ") ")) return std::nullopt;
  recorded.stamp_ns = static_cast<std::int64_t>(*seconds) * kNsPerS + static_cast<std::int64_t>(*micros) * kNsPerUs;
  const std::size_t space = line.find(' ');
  if (space == std::string_view::npos || space == 0) return std::nullopt;
  recorded.interface = line.substr(0, space);
  line.remove_prefix(space + 1);

  drives::Message& frame = recorded.frame;
  const std::size_t hash = line.find('#');
  if (hash != 3 && hash != 8) return std::nullopt;
  auto id = take_number(line, 16, hash);
  frame.extended = hash == 8;
  if (id && frame.extended && (*id & kErrorFlag) != 0) {
    recorded.kind = Kind::kError;
    frame.extended = false;
    id = *id & ~kErrorFlag;
  }
  if (!id || *id > (hash == 8 ? 0x1FFFFFFFU : 0x7FFU)) return std::nullopt;
  frame.id = static_cast<std::uint32_t>(*id);
  frame.fd = take(line, "##");
  if (frame.fd ? !take_number(line, 16, 1) : !take(line, "#")) return std::nullopt;
  if (line.ends_with(" R") || line.ends_with(" T")) line.remove_suffix(2);
  if (take(line, "R")) {
    if (frame.fd || recorded.kind == Kind::kError) return std::nullopt;
    recorded.kind = Kind::kRemote;
    if (line.empty()) return recorded;
    const auto length = take_number(line, 10, 1);
    if (!length || *length > 8 || !line.empty()) return std::nullopt;
    frame.length = static_cast<std::uint8_t>(*length);
    return recorded;
  }
  while (line.size() >= 2) {
    const auto byte = take_number(line, 16, 2);
    if (!byte || frame.length == (frame.fd ? 64 : 8)) return std::nullopt;
    frame.data[frame.length++] = static_cast<std::uint8_t>(*byte);
  }
  if (!line.empty()) return std::nullopt;
  return recorded;
}

void FrameOrder::put(RecordedFrame frame) {
  const std::int64_t stamp_ns = frame.stamp_ns;
  waiting_.emplace(stamp_ns, std::move(frame));
}

bool FrameOrder::take(std::int64_t before_ns, RecordedFrame& frame) {
  if (waiting_.empty() || waiting_.begin()->first >= before_ns) return false;
  frame = std::move(waiting_.begin()->second);
  waiting_.erase(waiting_.begin());
  return true;
}

}  // namespace pmg::can
