// Ranges like those of a robot that walks faster forwards than backwards.
#pragma once

#include "pmg/command.hpp"

namespace pmg::command_response {

inline CommandLimits box() {
  CommandLimits limits;
  limits.lower = {-0.5, -0.35, -0.8, -0.15, -0.25, -0.2};
  limits.upper = {0.8, 0.35, 0.8, 0.5, 0.25, 0.02};
  return limits;
}

}  // namespace pmg::command_response
