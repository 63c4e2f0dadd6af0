// What code that reads and checks says of what it refuses.
#pragma once

#include <string>

namespace pmg::test {

/// The message of the Error that the action throws; "taken" if it throws nothing. Another error goes on.
template <typename Error, typename Action>
std::string refusal_by(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "taken";
}

}  // namespace pmg::test
