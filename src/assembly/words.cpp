#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "assembly/parameters.hpp"
#include "assembly/variation.hpp"

namespace pmg::assembly {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json interval_json(const evidence::Interval& interval) {
  return {{"value", number(interval.value)}, {"low", number(interval.low)}, {"high", number(interval.high)}};
}

Json variation_json(const Variation& one) {
  Json levels = Json::array();
  for (const LevelValue& level : one.levels) {
    levels.push_back({{"level", level.level},
                      {"runs", level.runs},
                      {"value", number(level.value.value)},
                      {"interval", {number(level.value.low), number(level.value.high)}}});
  }
  return {{"parameter", one.parameter},
          {"unit", one.unit},
          {"column", one.columns.front()},
          {"columns_that_change_together", one.columns},
          {"levels", levels},
          {"mean", interval_json(one.mean)},
          {"mean_differs_from_neutral", one.has_mean},
          {"spread", number(one.spread)},
          {"or_instead", one.or_instead},
          {"or_by", one.or_by},
          {"chance", number(one.chance)},
          {"deviations", number(one.deviations)},
          {"folds_won", number(one.folds_won)}};
}

/// Angles in degrees, all else in its own unit.
struct Shown {
  double factor = 1.0;
  std::string unit;
};

Shown shown(const Variation& one) {
  if (one.unit == "rad") return {180.0 / std::numbers::pi, " degrees"};
  return {1.0, one.unit.empty() ? "" : " " + one.unit};
}

std::string titles(const std::vector<std::string>& parameters) {
  std::vector<std::string> words;
  for (const std::string& parameter : parameters) words.push_back(title(parameter));
  return fmt::format("{}", fmt::join(words, " or "));
}

}  // namespace

std::string columns_text(const std::vector<std::string>& columns) {
  return fmt::format("{}{}", fmt::join(columns, " or "),
                     columns.size() > 1 ? ", which change together in these recordings" : "");
}

std::string value_text(const Variation& one, const evidence::Interval& value) {
  const auto [factor, unit] = shown(one);
  return fmt::format("{:.3g} ({:.3g} to {:.3g}){}", factor * value.value, factor * value.low, factor * value.high,
                     unit);
}

std::string spread_text(const Variation& one) {
  const auto [factor, unit] = shown(one);
  return fmt::format("mean {:.3g}, standard deviation {:.3g}{}", factor * one.mean.value, factor * one.spread, unit);
}

std::string sentence(const Variation& one, Levels levels) {
  std::string text = fmt::format("The {} differs from assembly to assembly, by column {}", title(one.parameter),
                                 columns_text(one.columns));
  if (levels == Levels::kListed) {
    std::vector<std::string> listed;
    for (const LevelValue& level : one.levels)
      listed.push_back(fmt::format("({}) {}", level.level, value_text(one, level.value)));
    text += fmt::format(": {}; {}", fmt::join(listed, ", "), spread_text(one));
  }
  text += ".";
  if (!one.or_instead.empty()) text += fmt::format(" It may as well be the {}.", titles(one.or_instead));
  if (!one.or_by.empty()) text += fmt::format(" Column {} parts the runs as well.", fmt::join(one.or_by, " or "));
  return text;
}

void add_to(nlohmann::ordered_json& json, const AssemblyDifferences& differences) {
  json["varies_by"] = Json::array();
  for (const Variation& one : differences.varies) json["varies_by"].push_back(variation_json(one));
  Json not_claimed = Json::array();
  for (const NotVarying& one : differences.not_claimed)
    not_claimed.push_back({{"parameter", one.parameter}, {"columns", one.columns}, {"why", one.why}});
  for (const UnusedColumn& one : differences.unused)
    not_claimed.push_back({{"parameter", nullptr}, {"columns", {one.column}}, {"why", one.why}});
  json["varies_by_not_claimed"] = not_claimed;
}

}  // namespace pmg::assembly
