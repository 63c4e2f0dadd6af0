// Of silence: no controller is heard, or none answers to a name.
#pragma once

#include <string>

#include "operator/operator_source.hpp"

namespace pmg::ops {

/// "no controller of this name answers on URL; heard: z1", for one of those may be meant. Where none is heard, what to
/// do.
std::string nobody_answers(const OperatorSource& source);

/// Where no controller is heard at all, or none of this name, and what to do.
std::string nobody_heard(const std::string& url, const std::string& robot = "");

}  // namespace pmg::ops
