// From the bytes that a terminal sends to keys.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::ops {

/// One press, by the name that key_named() knows; letters are lower-case.
struct TerminalKey {
  std::string name;
  bool shift = false;
  friend bool operator==(const TerminalKey&, const TerminalKey&) = default;
};

/// Escape is a key, and the first byte of what arrows and function keys send. It is a key unless "[" or "O" follows
/// within kEscape_ns: nobody types those so fast after it, and it is never lost, whatever else follows.
class TerminalKeys {
 public:
  static constexpr std::int64_t kEscape_ns = 40'000'000;     ///< terminals send a sequence in one piece
  static constexpr std::int64_t kSequence_ns = 500'000'000;  ///< what isn't whole by then is forgotten

  /// The keys that these bytes complete; sequences of other keys are dropped whole.
  std::vector<TerminalKey> take(std::string_view bytes, std::int64_t now_ns);
  /// Those that only time completes. To be called every 10 ms or so.
  std::vector<TerminalKey> wait(std::int64_t now_ns);

 private:
  void take_byte(char byte, std::int64_t now_ns, std::vector<TerminalKey>& keys);
  void finish_sequence(char last, std::vector<TerminalKey>& keys) const;

  std::string sequence_;  // from its Escape on; empty: none has begun
  std::int64_t since_ns_ = 0;
};

}  // namespace pmg::ops
