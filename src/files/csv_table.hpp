// A CSV file with a header: cells as text, and columns of numbers. Errors name file, line and column.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/config_error.hpp"

namespace pmg::files {

struct CsvTable {
  std::filesystem::path file;
  std::vector<std::string> header;
  int header_line = 1;
  std::vector<std::vector<std::string>> rows;  ///< each has header.size() cells; row i is line header_line + 1 + i

  std::optional<std::size_t> find(const std::string& column) const;
  Place place(std::size_t row) const { return {file.string(), header_line + 1 + static_cast<int>(row)}; }
  /// Throws ConfigError if the column is missing or a cell is not a finite number.
  std::vector<double> numbers(const std::string& column) const;
};

/// Cells are separated by commas, without quotes; lines end with "\n" or "\r\n". Skips lines above the header that
/// begin with #. Throws ConfigError on an unreadable file, an empty or repeated column name, a row of another
/// length, and a table without rows.
CsvTable read_csv(const std::filesystem::path& file);

/// (text) => (number; empty if the text is no number). NaN and infinities count as numbers here.
std::optional<double> to_number(const std::string& text);

}  // namespace pmg::files
