#include "evidence/thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"

namespace pmg::evidence {

namespace {

void put(const ThresholdRow& row, auto value) {
  std::visit(
      [&](auto* threshold) {
        *threshold = static_cast<decltype(threshold->value)>(value);
        threshold->set_on = kSetByHand;
      },
      row.row);
}

bool counts(const ThresholdRow& row) { return std::holds_alternative<work::CountThreshold*>(row.row); }

template <typename Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && number >= 0 &&
         std::isfinite(static_cast<double>(number));
}

}  // namespace

nlohmann::ordered_json thresholds_json(const ThresholdRows& rows) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ThresholdRow& row : rows) {
    std::visit(
        [&](const auto* t) {
          json.push_back({{"name", row.name},
                          {"value", t->value},
                          {"unit", t->unit},
                          {"reason", t->reason},
                          {"set_on", t->set_on}});
        },
        row.row);
  }
  return json;
}

void set(const ThresholdRows& rows, std::string_view setting) {
  const std::size_t equals = setting.find('=');
  const std::string_view name = setting.substr(0, equals);
  const auto row = std::ranges::find(rows, name, &ThresholdRow::name);
  if (row == rows.end()) {
    std::vector<std::string> names;
    for (const ThresholdRow& one : rows) names.push_back(one.name);
    const std::string nearest = files::nearest_name(name, names);
    throw std::invalid_argument(
        fmt::format("'{}' isn't a threshold; {}", name,
                    nearest.empty() ? "diagnosis.json lists them under options" : "did you mean " + nearest + "?"));
  }
  const std::string_view text = equals == std::string_view::npos ? "" : setting.substr(equals + 1);
  double number = 0.0;
  int count = 0;
  if (counts(*row) ? !parse(text, count) : !parse(text, number)) {
    throw std::invalid_argument(fmt::format("'{}' for the threshold {}; expected {} of at least 0", text, name,
                                            counts(*row) ? "a whole number" : "a number"));
  }
  counts(*row) ? put(*row, count) : put(*row, number);
}

void set_from_file(const ThresholdRows& rows, const std::filesystem::path& file) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  for (const ThresholdRow& row : rows) {
    const bool given = reader.has(row.name);
    std::visit(
        [&](const auto* threshold) {
          const auto value = reader.optional(row.name, threshold->value, files::non_negative());
          if (given) put(row, value);
        },
        row.row);
  }
  reader.finish();
}

std::vector<std::string> set_by_hand(const ThresholdRows& rows) {
  std::vector<std::string> names;
  for (const ThresholdRow& row : rows) {
    if (std::visit([](const auto* t) { return t->set_on == kSetByHand; }, row.row)) names.push_back(row.name);
  }
  return names;
}

}  // namespace pmg::evidence
