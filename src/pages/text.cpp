#include "pages/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pmg::pages {

namespace {

std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string escape_script(std::string json) {
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string number(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  constexpr int kDigits = 4;
  constexpr double kSmallest = 1e-4, kLargest = 1e7;  // without an exponent
  if (std::abs(value) < kSmallest || std::abs(value) >= kLargest) {
    const std::string text = fmt::format("{:.{}e}", value, kDigits - 1);
    const std::size_t e = text.find('e');
    return fmt::format("{}e{}", without_trailing_zeros(text.substr(0, e)), std::stoi(text.substr(e + 1)));
  }
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return without_trailing_zeros(fmt::format("{:.{}f}", value, std::max(0, kDigits - before_point)));
}

}  // namespace pmg::pages
