// A mode and its sub-state in words, for people.
#pragma once

#include <string>

#include "control/mode.hpp"

namespace pmg::control {

/// "stand", or "stand, hanging" when the feet carry nothing and the policy isn't run.
inline std::string mode_text(Mode mode, bool hanging) {
  return std::string(to_string(mode)) + (hanging ? ", hanging" : "");
}

}  // namespace pmg::control
