// (a terminal's bytes) => keys.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::ops {

/// One press. The name is one of key_named(); letters are lower-case.
struct TerminalKey {
  std::string name;
  bool shift = false;
  friend bool operator==(const TerminalKey&, const TerminalKey&) = default;
};

/// The byte Escape is a key by itself, and the first byte of an arrow's or function key's sequence. It counts as a key
/// unless
/// "[" or "O" follows within kEscape_ns; no person types that fast. So Escape is never lost.
class TerminalKeys {
 public:
  static constexpr std::int64_t kEscape_ns = 40'000'000;     ///< terminals send a sequence in one piece
  static constexpr std::int64_t kSequence_ns = 500'000'000;  ///< an incomplete sequence is dropped after this time

  /// The keys that are complete with these bytes. Sequences of other keys are dropped.
  std::vector<TerminalKey> take(std::string_view bytes, std::int64_t now_ns);
  /// The keys that are complete by time alone. Call about every 10 ms.
  std::vector<TerminalKey> wait(std::int64_t now_ns);

 private:
  void take_byte(char byte, std::int64_t now_ns, std::vector<TerminalKey>& keys);
  void finish_sequence(char last, std::vector<TerminalKey>& keys) const;

  std::string sequence_;  // bytes from Escape on; empty: no sequence has begun
  std::int64_t since_ns_ = 0;
};

}  // namespace pmg::ops
