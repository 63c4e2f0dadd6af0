// Of a name that no controller answers to.
#pragma once

#include <string>

#include "operator/operator_source.hpp"

namespace pmg::ops {

/// "no controller of this name answers on URL; heard: z1", for one of those may be meant.
std::string nobody_answers(const OperatorSource& source);

/// What to do where no controller is heard at all.
inline constexpr const char* kStartOne = "start pmg_controller, or give --lcm-url the address that it names";

}  // namespace pmg::ops
