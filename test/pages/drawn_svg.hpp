// Reads an SVG picture back: its elements' places, and the values of places by its ticks.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace pmg::pages {

struct DrawnElement {
  std::string tag, text;
  std::map<std::string, std::string> attributes;

  double number(const std::string& name) const { return std::stod(attributes.at(name)); }
  bool is(const std::string& name) const {
    const auto found = attributes.find("class");
    return found != attributes.end() && (" " + found->second + " ").find(" " + name + " ") != std::string::npos;
  }
};

inline std::vector<DrawnElement> drawn_elements(const std::string& svg) {
  static const std::regex kElement(R"re(<(rect|path|text|circle)((?:\s+[\w-]+="[^"]*")*)\s*(/?)>([^<]*))re");
  static const std::regex kAttribute(R"re(([\w-]+)="([^"]*)")re");
  std::vector<DrawnElement> elements;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kElement), end; it != end; ++it) {
    DrawnElement element{.tag = (*it)[1], .text = (*it)[3].length() > 0 ? "" : (*it)[4].str(), .attributes = {}};
    const std::string attributes = (*it)[2];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), kAttribute); a != end; ++a) {
      element.attributes[(*a)[1]] = (*a)[2];
    }
    elements.push_back(element);
  }
  return elements;
}

/// The whole text as a number.
inline std::optional<double> label_value(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return text.empty() || *end != '\0' ? std::nullopt : std::optional(value);
}

/// Places of ticks, and the values in their labels.
struct DrawnAxis {
  std::vector<double> at, value;
  std::vector<std::string> labels;

  void add(double place, const std::string& label) {
    const auto told = label_value(label);
    if (!told) return;
    at.push_back(place);
    value.push_back(*told);
    labels.push_back(label);
  }
  double per_unit() const { return (value.back() - value.front()) / (at.back() - at.front()); }
  double operator()(double place) const { return value.front() + (place - at.front()) * per_unit(); }
  double place(double of) const { return at.front() + (of - value.front()) / per_unit(); }

  /// Expects at least two ticks, no repeated label, and each tick at its value's place within `within` of the picture's
  /// unit.
  void expect_sound(double within) const {
    ASSERT_GE(at.size(), 2U) << "a reader needs two ticks";
    for (std::size_t i = 0; i < labels.size(); ++i) {
      EXPECT_EQ(std::ranges::count(labels, labels[i]), 1) << labels[i] << " is read more than once";
      EXPECT_LE(labels[i].size(), 22U) << labels[i];
      EXPECT_NEAR(place(value[i]), at[i], within) << "the label " << labels[i] << " is not what stands there";
    }
  }
};

/// Points of a path, by stretch. The pictures write H and V in upper case.
inline std::vector<std::vector<std::pair<double, double>>> pen_stops(const std::string& d) {
  std::vector<std::vector<std::pair<double, double>>> stretches;
  static const std::regex kStep(R"(([MLHVZ])\s*([-0-9.e]*)\s*([-0-9.e]*))");
  double x = 0.0, y = 0.0;
  for (std::sregex_iterator it(d.begin(), d.end(), kStep), end; it != end; ++it) {
    const char step = (*it)[1].str().front();
    if (step == 'Z') continue;
    if (step == 'M') stretches.emplace_back();
    if (step != 'V') x = std::stod((*it)[2]);
    if (step == 'V') y = std::stod((*it)[2]);
    if (step == 'M' || step == 'L') y = std::stod((*it)[3]);
    stretches.back().emplace_back(x, y);
  }
  return stretches;
}

}  // namespace pmg::pages
