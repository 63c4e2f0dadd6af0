#include "pages/table_text.hpp"

#include <algorithm>
#include <sstream>

namespace pmg::pages {

namespace {

/// Characters of UTF-8.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

/// Or nothing, or what stands for a number that isn't there.
bool is_number(const std::string& text) {
  const std::size_t sign = text.find_first_not_of("+-");
  return sign == std::string::npos || text == "nan" || (sign <= 1 && text[sign] >= '0' && text[sign] <= '9');
}

/// A row may be shorter than the header.
std::string cell(const std::vector<std::string>& row, std::size_t c) { return c < row.size() ? row[c] : ""; }

struct Column {
  std::size_t width = 0;
  bool right = true;
  std::vector<std::string> header;  ///< lines

  std::string padded(const std::string& text) const {
    const std::string space(width - std::min(width, width_of(text)), ' ');
    return right ? space + text : text + space;
  }
};

/// (text, words in a line are no longer than this together) => (lines).
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (lines.empty() || width_of(lines.back()) + 1 + width_of(word) > width) {
      lines.push_back(word);
    } else {
      lines.back() += " " + word;
    }
  }
  return lines;
}

Column column_of(const Table& table, std::size_t c) {
  Column column;
  for (const auto& row : table.rows) {
    column.width = std::max(column.width, width_of(cell(row, c)));
    column.right = column.right && is_number(cell(row, c));
  }
  for (const std::string& word : wrapped(table.header[c], 0)) column.width = std::max(column.width, width_of(word));
  column.header = wrapped(table.header[c], column.width);
  return column;
}

}  // namespace

std::vector<std::string> lines_of(const Table& table) {
  std::vector<Column> columns;
  std::size_t header_lines = 0;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    columns.push_back(column_of(table, c));
    header_lines = std::max(header_lines, columns.back().header.size());
  }
  std::vector<std::string> lines;
  const auto add = [&](const auto& text) {
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c) line += (c > 0 ? "  " : "") + columns[c].padded(text(c));
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(line);
  };
  for (std::size_t k = 0; k < header_lines; ++k) {
    add([&](std::size_t c) {
      const std::size_t above = header_lines - columns[c].header.size();
      return k < above ? std::string() : columns[c].header[k - above];
    });
  }
  for (const auto& row : table.rows) add([&](std::size_t c) { return cell(row, c); });
  return lines;
}

}  // namespace pmg::pages
