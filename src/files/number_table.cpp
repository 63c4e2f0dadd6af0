#include "files/number_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "files/bounded_file.hpp"

namespace pmg::files {
namespace {

struct Cell {
  std::string_view text;
  int column = 1;  ///< position of its first character in the line, from 1
};

std::vector<Cell> split(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t start = 0;;) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    cells.push_back({line.substr(start, comma - start), static_cast<int>(start) + 1});
    if (comma == line.size()) return cells;
    start = comma + 1;
  }
}

std::vector<std::string> read_header(const std::string& file, std::string_view line,
                                     const std::vector<std::string>& expected, const std::string& which_they_are) {
  std::vector<std::string> columns;
  for (const Cell& cell : split(line)) {
    const Place place{file, 1, cell.column};
    const std::string name(cell.text);
    if (std::ranges::find(expected, name) == expected.end()) raise(place, name, "is an unknown column", which_they_are);
    if (std::ranges::find(columns, name) != columns.end()) raise(place, name, "is there twice", "it once");
    columns.push_back(name);
  }
  for (const std::string& name : expected) {
    if (std::ranges::find(columns, name) == columns.end())
      raise({file, 1}, name, "is missing", "a column for " + which_they_are);
  }
  return columns;
}

double read_number(const Place& place, const std::string& column, std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    raise(place, column, fmt::format("is '{}'", text), "a finite number");
  }
  return value;
}

void strip_carriage_return(std::string& text) {
  if (!text.empty() && text.back() == '\r') text.pop_back();
}

}  // namespace

NumberTable read_number_table(const std::filesystem::path& file, const std::vector<std::string>& expected,
                              const std::string& which_they_are) {
  std::istringstream stream(read_bounded_text(file, kLargestTable_bytes, "a CSV file with a header"));
  std::string line;
  if (!std::getline(stream, line)) {
    raise({file.string()}, "", "cannot be read (it is empty)", "a CSV file with a header");
  }
  strip_carriage_return(line);
  NumberTable table;
  table.file = file;
  table.columns = read_header(file.string(), line, expected, which_they_are);
  for (int number = 2; std::getline(stream, line); ++number) {
    strip_carriage_return(line);
    if (line.empty()) continue;
    const std::vector<Cell> cells = split(line);
    if (cells.size() != table.columns.size()) {
      raise({file.string(), number}, "", fmt::format("has {} columns", cells.size()),
            fmt::format("{}", table.columns.size()));
    }
    std::vector<double>& row = table.rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      row.push_back(read_number({file.string(), number, cells[i].column}, table.columns[i], cells[i].text));
    }
    table.line.push_back(number);
  }
  return table;
}

std::string format_number_table(const std::vector<std::string>& columns, const std::vector<std::vector<double>>& rows) {
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  for (const std::vector<double>& row : rows) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

}  // namespace pmg::files
