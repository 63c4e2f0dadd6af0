// What a program says as JSON.
#pragma once

#include <iostream>

namespace pmg::apps {

/// Pure ASCII: names that other programs chose reach no terminal raw; broken UTF-8 becomes U+FFFD. indent: -1: one
/// line.
template <typename Json>
void print_json(const Json& json, int indent = 2) {
  std::cout << json.dump(indent, ' ', true, Json::error_handler_t::replace) << '\n';
}

}  // namespace pmg::apps
