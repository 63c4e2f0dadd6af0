// Which rows of runs.csv: "kp_firmware in 4,8,16,32 and repeat == 0".
#pragma once

#include <string>
#include <vector>

#include "bench/csv_table.hpp"

namespace pmg::bench {

/// Terms joined by `and`: COLUMN in V,V,... | not in V,V,... | == V | != V | < V | <= V | > V | >= V. Values that are
/// numbers on both sides compare as numbers, others as text; < and its kin need numbers.
class RowFilter {
 public:
  /// Throws std::invalid_argument that says what can't be read. Empty text keeps every row.
  explicit RowFilter(const std::string& text);

  /// One flag a row. Throws std::invalid_argument naming the columns when one isn't there.
  std::vector<bool> keeps(const CsvTable& table) const;

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
