#include "pages/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace pmg::pages {

std::string escape_html(std::string_view text) {
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
  if (value != 0.0 && std::abs(value) < 1e-3) return fmt::format("{:.2g}", value);
  std::string text = fmt::format("{:.{}f}", value,
                                 std::abs(value) >= 1000.0  ? 0
                                 : std::abs(value) >= 100.0 ? 1
                                 : std::abs(value) >= 10.0  ? 2
                                                            : 3);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

}  // namespace pmg::pages
