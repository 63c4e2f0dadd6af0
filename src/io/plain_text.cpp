#include "io/plain_text.hpp"

namespace pmg::io {

std::string plain_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string plain;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '\\') {
      plain += "\\\\";
    } else if (byte >= 0x20 && byte < 0x7f) {
      plain += letter;
    } else {
      plain += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return plain;
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
