// Selection of rows of runs.csv, such as "kp_firmware in 4,8,16,32 and repeat == 0".
#pragma once

#include <string>
#include <vector>

#include "files/csv_table.hpp"

namespace pmg::bench {

/// Terms joined by `and`: COLUMN in V,V,... | not in V,V,... | == V | != V | < V | <= V | > V | >= V. Two numbers
/// compare as numbers, other values as text. The last four relations need numbers.
class RowFilter {
 public:
  /// An empty text keeps every row. Throws std::invalid_argument that quotes the unreadable part.
  explicit RowFilter(const std::string& text);

  /// One flag per row. Throws std::invalid_argument that lists the table's columns if a column is missing.
  std::vector<bool> keeps(const files::CsvTable& table) const;

  const std::string& text() const { return text_; }

 private:
  struct Term {
    std::string column, relation;
    std::vector<std::string> values;
  };
  static bool holds(const Term& term, const std::string& cell);
  std::string text_;
  std::vector<Term> terms_;
};

}  // namespace pmg::bench
