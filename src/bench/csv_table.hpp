// A CSV file with a header: cells as text, and columns of numbers with errors that name file, line and column.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/config_error.hpp"

namespace pmg::bench {

struct CsvTable {
  std::filesystem::path file;
  std::vector<std::string> header;
  int header_line = 1;
  std::vector<std::vector<std::string>> rows;  ///< each of header.size() cells, one a line below the header

  std::optional<std::size_t> find(const std::string& column) const;
  files::Place place(std::size_t row) const { return {file.string(), header_line + 1 + static_cast<int>(row)}; }
  /// Throws files::ConfigError on a missing column and on what isn't a finite number.
  std::vector<double> numbers(const std::string& column) const;
};

/// A comma between cells, no quoting, "\n" or "\r\n"; lines above the header that begin with # are passed over. Throws
/// files::ConfigError on a file that can't be read, an empty or repeated column name, a row of another length, and a
/// table without rows.
CsvTable read_csv(const std::filesystem::path& file);

/// Nothing when the text isn't a number; NaN and infinities are numbers here.
std::optional<double> to_number(const std::string& text);

}  // namespace pmg::bench
