#include "bench/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "files/bounded_file.hpp"

namespace pmg::bench {

namespace {

std::vector<std::string> cells(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> found;
  std::size_t from = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', from)) {
    found.push_back(line.substr(from, comma - from));
    from = comma + 1;
  }
  found.push_back(line.substr(from));
  return found;
}

void check_header(const CsvTable& table) {
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
    if (table.header.size() == 1 && table.header.front().find(separator) != std::string::npos)
      files::raise({table.file.string(), table.header_line}, "", fmt::format("columns are parted by {}", name),
                   "commas, and decimals behind a point");
  }
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const std::string& name = table.header[c];
    const files::Place place{table.file.string(), table.header_line};
    if (name.empty()) files::raise(place, "", fmt::format("column {} has no name", c + 1), "a name in every column");
    if (std::count(table.header.begin(), table.header.end(), name) > 1) {
      files::raise(place, name, "is there twice", "it once");
    }
  }
}

}  // namespace

std::optional<double> to_number(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<std::size_t> CsvTable::find(const std::string& column) const {
  const auto found = std::find(header.begin(), header.end(), column);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  const std::optional<std::size_t> c = find(column);
  if (!c) files::raise({file.string(), header_line}, column, "is missing", "a column of that name");
  std::vector<double> values;
  values.reserve(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string& text = rows[r][*c];
    const std::optional<double> value = to_number(text);
    if (!value || !std::isfinite(*value)) {
      files::raise(place(r), column, text.empty() ? "is empty" : "is '" + text + "'", "a finite number");
    }
    values.push_back(*value);
  }
  return values;
}

CsvTable read_csv(const std::filesystem::path& file) {
  std::istringstream stream(files::read_bounded_text(file, files::kLargestTable_bytes, "a CSV file"));
  CsvTable table;
  table.file = file;
  std::string line;
  while (std::getline(stream, line) && line.starts_with('#')) ++table.header_line;
  if (stream) table.header = cells(line);
  check_header(table);
  while (std::getline(stream, line)) {
    if (line.empty() && stream.peek() == std::istringstream::traits_type::eof()) break;
    table.rows.push_back(cells(line));
    const std::size_t count = table.rows.back().size();
    if (count == table.header.size()) continue;
    files::raise(table.place(table.rows.size() - 1), "", fmt::format("{} cells", count),
                 fmt::format("{} as in the header", table.header.size()));
  }
  if (table.rows.empty()) files::raise({file.string()}, "", "no rows below the header", "at least one");
  return table;
}

}  // namespace pmg::bench
