#include "io/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace pmg::io {

namespace {

/// Code points that act on a terminal or on the letters around them instead of being seen.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 11> kUnseen = {{
    {0x00, 0x1f},        // control characters: ESC, newline, ...
    {0x7f, 0x9f},        // DEL and the control characters of 8-bit terminals
    {0xad, 0xad},        // soft hyphen
    {0x61c, 0x61c},      // direction of writing
    {0x180e, 0x180e},    // zero width
    {0x200b, 0x200f},    // zero width, direction
    {0x2028, 0x202e},    // line separators, direction
    {0x2060, 0x206f},    // zero width, direction
    {0xd800, 0xdfff},    // halves of surrogate pairs: no letters in UTF-8
    {0xfeff, 0xfeff},    // byte-order mark
    {0xe0000, 0xfffff},  // tags, private use
}};

/// Bytes of the letter with which this text begins, if it is well-formed UTF-8 and can be seen; otherwise 0.
std::size_t visible_letter(std::string_view text) noexcept {
  constexpr std::array<std::uint32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};  // by bytes: longer forms are none
  const auto byte = [&](std::size_t i) -> std::uint32_t { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = byte(0) < 0x80            ? 1
                           : byte(0) >> 5 == 0b110   ? 2
                           : byte(0) >> 4 == 0b1110  ? 3
                           : byte(0) >> 3 == 0b11110 ? 4
                                                     : 0;
  if (size == 0 || size > text.size()) return 0;
  std::uint32_t point = size == 1 ? byte(0) : byte(0) & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if (byte(i) >> 6 != 0b10) return 0;
    point = point << 6 | (byte(i) & 0x3f);
  }
  const bool unseen =
      std::ranges::any_of(kUnseen, [&](const auto& range) { return point >= range.first && point <= range.second; });
  return unseen || point < kSmallest[size] || point >= 0x100000 ? 0 : size;
}

}  // namespace

std::string plain_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string plain;
  while (!text.empty()) {
    const std::size_t letter = visible_letter(text);
    if (letter == 0) {
      const auto byte = static_cast<unsigned char>(text.front());
      plain += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    } else {
      if (text.front() == '\\') plain += '\\';
      plain += text.substr(0, letter);
    }
    text.remove_prefix(std::max<std::size_t>(letter, 1));
  }
  return plain;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::vector<std::string> lines;
  while (true) {
    const std::string lead(lines.empty() ? 0 : indent, ' ');
    const std::size_t room = width > lead.size() ? width - lead.size() : 1;
    std::size_t end = text.size();
    if (end > room) {
      end = text.rfind(' ', room);
      if (end == std::string_view::npos || text.find_first_not_of(' ') >= end)
        end = std::min(text.find(' ', room), text.size());
    }
    lines.push_back(lead + std::string(text.substr(0, end)));
    const std::size_t next = text.find_first_not_of(' ', end);
    if (next == std::string_view::npos) return lines;
    text.remove_prefix(next);
  }
}

std::string csv_text(std::string_view text) {
  std::string plain = plain_text(text);
  const bool formula = !plain.empty() && std::string_view("=+-@").find(plain.front()) != std::string_view::npos;
  if (formula) plain.insert(plain.begin(), '\'');
  if (plain.find_first_of(",\"") == std::string::npos) return plain;
  std::string quoted = "\"";
  for (const char letter : plain) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

}  // namespace pmg::io
