#include "bench/row_filter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

namespace pmg::bench {

namespace {

constexpr std::array kRelations = {"==", "!=", "<=", ">=", "<", ">"};

[[noreturn]] void refuse(const std::string& text, const std::string& wrong) {
  throw std::invalid_argument(
      fmt::format("filter '{}': {}; expected terms like 'kp_firmware in 4,8 and repeat == 0'", text, wrong));
}

/// (text) => (words). A relation is a word of its own; a list is one word, without spaces at its commas.
std::vector<std::string> words(const std::string& text) {
  std::string spaced;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '=' || c == '!' || c == '<' || c == '>') {
      const bool two = i + 1 < text.size() && text[i + 1] == '=';
      spaced += fmt::format(" {}{} ", c, two ? "=" : "");
      i += two ? 1 : 0;
    } else if (c == ',') {
      while (!spaced.empty() && spaced.back() == ' ') spaced.pop_back();
      spaced += ',';
      while (i + 1 < text.size() && text[i + 1] == ' ') ++i;
    } else {
      spaced += c;
    }
  }
  std::istringstream stream(spaced);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) found.push_back(word);
  return found;
}

std::vector<std::string> list(const std::string& word) {
  std::vector<std::string> values;
  std::istringstream stream(word);
  for (std::string value; std::getline(stream, value, ',');) values.push_back(value);
  return values;
}

bool equal(const std::string& a, const std::string& b) {
  const auto x = files::to_number(a), y = files::to_number(b);
  return x && y ? *x == *y : a == b;
}

}  // namespace

RowFilter::RowFilter(const std::string& text) : text_(text) {
  const std::vector<std::string> found = words(text);
  std::size_t i = 0;
  const auto next = [&](const char* what) {
    if (i >= found.size()) refuse(text, fmt::format("ends where {} should be", what));
    return found[i++];
  };
  while (i < found.size()) {
    Term term;
    term.column = next("a column's name");
    term.relation = next("a relation");
    if (term.relation == "not") {
      if (next("in") != "in") refuse(text, "'not' without 'in'");
      term.relation = "not in";
    }
    const bool of_list = term.relation == "in" || term.relation == "not in";
    if (!of_list && std::find(kRelations.begin(), kRelations.end(), term.relation) == kRelations.end()) {
      refuse(text, fmt::format("'{}' isn't a relation", term.relation));
    }
    const std::string values = next("a value");
    term.values = of_list ? list(values) : std::vector{values};
    terms_.push_back(term);
    if (i < found.size() && next("and") != "and") refuse(text, fmt::format("'{}' where 'and' should be", found[i - 1]));
    if (i == found.size() && found.back() == "and") refuse(text, "ends with 'and'");
  }
}

bool RowFilter::holds(const Term& term, const std::string& cell) {
  const auto is_cell = [&](const std::string& value) { return equal(value, cell); };
  const bool listed = std::any_of(term.values.begin(), term.values.end(), is_cell);
  if (term.relation == "in" || term.relation == "==") return listed;
  if (term.relation == "not in" || term.relation == "!=") return !listed;
  const auto x = files::to_number(cell), y = files::to_number(term.values.front());
  if (!x || !y) {
    throw std::invalid_argument(fmt::format("{} {} {}: '{}' isn't a number", term.column, term.relation,
                                            term.values.front(), x ? term.values.front() : cell));
  }
  if (term.relation == "<") return *x < *y;
  if (term.relation == "<=") return *x <= *y;
  return term.relation == ">" ? *x > *y : *x >= *y;
}

std::vector<bool> RowFilter::keeps(const files::CsvTable& table) const {
  std::vector<bool> kept(table.rows.size(), true);
  for (const Term& term : terms_) {
    const auto column = table.find(term.column);
    if (!column)
      refuse(text_, fmt::format("{} has no column '{}' but {}", table.file.string(), term.column,
                                fmt::join(table.header, ", ")));
    for (std::size_t r = 0; r < kept.size(); ++r) kept[r] = kept[r] && holds(term, table.rows[r][*column]);
  }
  return kept;
}

}  // namespace pmg::bench
