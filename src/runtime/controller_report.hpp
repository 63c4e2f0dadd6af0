// How punctual a run of the threaded controller was: for people and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/controller.hpp"

namespace pmg::runtime {

/// Of a stopped controller. Delayed cycles are those that the host began over 2 ms late, listed apart with their times
/// since the first cycle; percentiles are over all cycles.
nlohmann::ordered_json punctuality_json(const Controller& controller);

/// The same as lines of text.
std::vector<std::string> punctuality_lines(const Controller& controller);

}  // namespace pmg::runtime
