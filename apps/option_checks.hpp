// Checks of option values, with the same plain words in help and errors. CLI11's own ranges print the largest double
// with 300 digits and accept NaN.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "files/nearest_name.hpp"

namespace pmg::apps {

/// help: text after the option's type, as in "--jobs INT:1 to 64". expected: end of the error "'-1' isn't a number
/// ...".
inline CLI::Validator number_check(const std::string& help, const std::string& expected,
                                   const std::function<bool(double)>& holds) {
  return {[expected, holds](std::string& text) {
            const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
            const char* const end = text.data() + text.size();
            double value = 0.0;
            const auto [stop, error] = std::from_chars(begin, end, value);
            const bool good = error == std::errc() && stop == end && std::isfinite(value) && holds(value);
            const bool comma = error == std::errc() && stop != end && *stop == ',';
            return good ? std::string()
                        : fmt::format("'{}' isn't {}{}", text, expected, comma ? "; decimals come behind a point" : "");
          },
          help};
}

inline CLI::Validator finite() {
  return number_check("", "a finite number", [](double) { return true; });
}
inline CLI::Validator positive() {
  return number_check("above 0", "a number above 0", [](double value) { return value > 0.0; });
}
inline CLI::Validator non_negative() {
  return number_check("0 or more", "a number of at least 0", [](double value) { return value >= 0.0; });
}
/// A range that includes both ends.
inline CLI::Validator in_range(double lower, double upper) {
  return number_check(fmt::format("{:g} to {:g}", lower, upper),
                      fmt::format("a number from {:g} to {:g}", lower, upper),
                      [lower, upper](double value) { return value >= lower && value <= upper; });
}

inline CLI::Validator one_of(const std::vector<std::string>& names) {
  return {[names](std::string& text) {
            const bool known = std::ranges::find(names, text) != names.end();
            return known ? std::string() : fmt::format("'{}' isn't known; {}", text, files::expected_name(text, names));
          },
          fmt::format("{}", fmt::join(names, "|"))};
}

}  // namespace pmg::apps
