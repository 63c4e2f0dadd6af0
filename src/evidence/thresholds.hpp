// The thresholds that a diagnosis decides by: listed in its JSON, set by --set.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "work/threshold.hpp"

namespace pmg::evidence {

/// A row of a struct of thresholds, by its name: "ground.slipping_m_s". Refers to the struct.
struct ThresholdRow {
  std::string name;
  std::variant<work::Threshold*, work::CountThreshold*> row;
};
using ThresholdRows = std::vector<ThresholdRow>;

/// Every row of the struct (PMG_THRESHOLDS), and of those in it, in their order. Names begin with the prefix.
template <typename Thresholds>
ThresholdRows rows(Thresholds& thresholds, const std::string& prefix = "") {
  ThresholdRows all;
  thresholds.each_threshold([&](std::string_view name, auto& member) {
    const std::string whole = prefix + std::string(name);
    if constexpr (requires { &member.reason; }) {
      all.push_back({whole, &member});
    } else {
      for (ThresholdRow& row : rows(member, whole + ".")) all.push_back(std::move(row));
    }
  });
  return all;
}

/// [{name, value, unit, reason, set_on}], in their order.
nlohmann::ordered_json thresholds_json(const ThresholdRows& rows);

/// The same of a struct.
template <typename Thresholds>
auto thresholds_json(Thresholds thresholds) {
  return thresholds_json(rows(thresholds));
}

/// Sets a row from "NAME=VALUE". Its set_on becomes kSetByHand. Throws std::invalid_argument, with the nearest name, on
/// another name and on what isn't a number of at least 0, for a count a whole one.
void set(const ThresholdRows& rows, std::string_view setting);

/// Sets the rows of a YAML mapping: "NAME: VALUE" lines. Throws files::ConfigError as set() does.
void set_from_file(const ThresholdRows& rows, const std::filesystem::path& file);

inline constexpr std::string_view kSetByHand = "set by hand";

/// Names of the rows that were set by hand.
std::vector<std::string> set_by_hand(const ThresholdRows& rows);

}  // namespace pmg::evidence
