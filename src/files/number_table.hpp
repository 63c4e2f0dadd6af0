// A CSV file of numbers: a header of column names, then rows of finite numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/config_error.hpp"

namespace pmg::files {

struct NumberTable {
  std::filesystem::path file;
  std::vector<std::string> columns;       ///< as in the file
  std::vector<std::vector<double>> rows;  ///< each as long as columns
  std::vector<int> line;                  ///< line number of each row

  Place place(std::size_t row) const { return {file.string(), line[row]}; }
};

/// The columns are the expected ones, each once, in any order. which_they_are describes them in the error about an
/// unknown column ("the name of one of the robot's joints"). Throws ConfigError on a missing, unknown or repeated
/// column, a row of another length, and a cell that isn't a finite number.
NumberTable read_number_table(const std::filesystem::path& file, const std::vector<std::string>& expected,
                              const std::string& which_they_are);

/// The text from which read_number_table reads the same numbers.
std::string format_number_table(const std::vector<std::string>& columns, const std::vector<std::vector<double>>& rows);

}  // namespace pmg::files
