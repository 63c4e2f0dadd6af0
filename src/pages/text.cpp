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

/// Columns that a text takes on a console; every code point takes one.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
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

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

std::vector<std::string> console_lines(const Table& table) {
  std::vector<std::string> names = table.header, units(table.header.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::size_t unit = names[c].rfind(" [");
    if (unit == std::string::npos) continue;
    units[c] = names[c].substr(unit + 1);
    names[c].erase(unit);
  }
  std::vector<std::vector<std::string>> rows = {names, units};
  if (std::ranges::all_of(units, &std::string::empty)) rows.pop_back();
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  std::vector<std::string> lines;
  for (const std::vector<std::string>& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - width(row[c]), ' ');
      line += c == 0 ? row[c] + padding : "  " + padding + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(line);
  }
  lines.emplace_back();
  return lines;
}

}  // namespace pmg::pages
