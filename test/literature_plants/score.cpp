#include "score.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace pmg::literature {

namespace {

using Value = nlohmann::json;
using Names = std::set<std::string>;

/// Of each effect its names: its own, and those of effects that are the same on its rig.
struct PlantedNames {
  std::vector<Names> all, strong;
};

bool meets(const Names& a, const Names& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) { return b.contains(name); });
}

bool meets_any(const Names& names, const std::vector<Names>& others) {
  return std::any_of(others.begin(), others.end(), [&](const Names& one) { return meets(names, one); });
}

PlantedNames planted(const Value& truth) {
  PlantedNames names;
  for (const Value& effect : truth.at("effects")) {
    Names one = {effect.at("effect").get<std::string>()};
    if (effect.contains("same_here")) {
      for (const Value& other : effect.at("same_here")) one.insert(other.get<std::string>());
    }
    names.all.push_back(one);
    if (effect.at("moves_floors").get<double>() >= kStrong_floors) names.strong.push_back(one);
  }
  return names;
}

/// A cause with what it can't be told from.
std::vector<Names> suspects(const Value& diagnosis) {
  std::vector<Names> found;
  for (const Value& cause : diagnosis.at("causes")) {
    Names names = {cause.at("effect").get<std::string>()};
    if (cause.contains("or_instead")) {
      for (const Value& other : cause.at("or_instead")) names.insert(other.get<std::string>());
    }
    found.push_back(names);
  }
  return found;
}

/// Every strong effect is among the suspects, one cause each, and every cause has a planted effect among its suspects.
bool contains_truth(const PlantedNames& truth, const Value& diagnosis) {
  const std::vector<Names> all = suspects(diagnosis);
  return std::all_of(all.begin(), all.end(), [&](const Names& names) { return meets_any(names, truth.all); }) &&
         std::all_of(truth.strong.begin(), truth.strong.end(),
                     [&](const Names& names) { return meets_any(names, all); });
}

bool names_truth(const PlantedNames& truth, const Value& diagnosis) {
  if (diagnosis.at("verdict") != "found") return false;
  Names named;
  for (const Value& cause : diagnosis.at("causes")) named.insert(cause.at("effect").get<std::string>());
  return std::all_of(named.begin(), named.end(),
                     [&](const std::string& name) { return meets_any({name}, truth.all); }) &&
         std::all_of(truth.strong.begin(), truth.strong.end(), [&](const Names& names) { return meets(names, named); });
}

std::vector<ScoredParameter> scored_parameters(const Value& truth, const Value& diagnosis) {
  std::map<std::string, double> numbers;
  for (const Value& effect : truth.at("effects")) {
    for (const auto& [name, value] : effect.at("parameters").items()) numbers[name] = value.get<double>();
  }
  std::vector<ScoredParameter> scored;
  for (const Value& cause : diagnosis.at("causes")) {
    for (const auto& [name, interval] : cause.at("parameters").items()) {
      const auto number = numbers.find(name);
      if (number == numbers.end()) continue;
      scored.push_back({name, number->second, interval.at("low").get<double>(), interval.at("high").get<double>()});
    }
  }
  return scored;
}

}  // namespace

Score score(const Value& result) {
  const Value &truth = result.at("truth"), &diagnosis = result.at("diagnosis");
  const PlantedNames names = planted(truth);
  Score s;
  s.seed = truth.at("seed").get<std::uint64_t>();
  s.kind = truth.at("kind").get<std::string>();
  s.verdict = diagnosis.at("verdict").get<std::string>();
  s.strong = !names.strong.empty();
  s.ambiguous = s.verdict == "ambiguous";
  s.named = s.ambiguous ? contains_truth(names, diagnosis) : names_truth(names, diagnosis);
  s.settled = result.contains("asked") && !result.at("asked").is_null() && names_truth(names, result.at("asked"));
  for (const Names& cause : suspects(diagnosis)) {
    s.accused = s.accused || !meets_any(cause, names.all);
  }
  if (s.named) s.parameters = scored_parameters(truth, diagnosis);
  s.seconds = result.at("seconds").get<double>();
  return s;
}

}  // namespace pmg::literature
