#include "keyboard/terminal_keys.hpp"

namespace pmg::ops {

namespace {

constexpr char kEscape = '\x1b';
constexpr std::size_t kLongestSequence = 32;  // longer ones are no key

const TerminalKey kEscapeKey{.name = "escape"};

/// The key of a single byte; without a name it is no key.
TerminalKey plain(char byte) {
  if (byte == '\r' || byte == '\n') return {.name = "enter"};
  if (byte == ' ') return {.name = "space"};
  if (byte == '\x7f' || byte == '\b') return {.name = "backspace"};
  if (byte >= 'a' && byte <= 'z') return {.name = std::string(1, byte)};
  if (byte >= 'A' && byte <= 'Z') return {.name = std::string(1, static_cast<char>(byte - 'A' + 'a')), .shift = true};
  return {};
}

bool ends_sequence(char byte) { return byte >= '@' && byte <= '~'; }

}  // namespace

std::vector<TerminalKey> TerminalKeys::take(std::string_view bytes, std::int64_t now_ns) {
  std::vector<TerminalKey> keys = wait(now_ns);
  for (const char byte : bytes) take_byte(byte, now_ns, keys);
  return keys;
}

std::vector<TerminalKey> TerminalKeys::wait(std::int64_t now_ns) {
  std::vector<TerminalKey> keys;
  if (sequence_.size() == 1 && now_ns - since_ns_ >= kEscape_ns) {
    keys.push_back(kEscapeKey);
    sequence_.clear();
  }
  if (sequence_.size() > 1 && now_ns - since_ns_ >= kSequence_ns) sequence_.clear();
  return keys;
}

void TerminalKeys::take_byte(char byte, std::int64_t now_ns, std::vector<TerminalKey>& keys) {
  if (byte == kEscape) {
    if (sequence_.size() == 1) keys.push_back(kEscapeKey);
    sequence_ = kEscape;
    since_ns_ = now_ns;
    return;
  }
  if (sequence_.size() == 1) {
    if (byte == '[' || byte == 'O') {
      sequence_ += byte;
      return;
    }
    keys.push_back(kEscapeKey);
    sequence_.clear();
  }
  if (sequence_.empty()) {
    if (TerminalKey key = plain(byte); !key.name.empty()) keys.push_back(std::move(key));
    return;
  }
  if (ends_sequence(byte)) finish_sequence(byte, keys);
  if (ends_sequence(byte) || sequence_.size() >= kLongestSequence) {
    sequence_.clear();
  } else {
    sequence_ += byte;
  }
}

void TerminalKeys::finish_sequence(char last, std::vector<TerminalKey>& keys) const {
  const bool shift = sequence_ == "\x1b[1;2";  // xterm's code
  if (!shift && sequence_.size() != 2) return;
  switch (last) {
    case 'A':
      return keys.push_back({.name = "up", .shift = shift});
    case 'B':
      return keys.push_back({.name = "down", .shift = shift});
    case 'C':
      return keys.push_back({.name = "right", .shift = shift});
    case 'D':
      return keys.push_back({.name = "left", .shift = shift});
    default:
      return;
  }
}

}  // namespace pmg::ops
