// What is known of a backend, for the header of a log.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hal/backend.hpp"

namespace pmg::hal {

/// Under the names of its members, without what isn't known or isn't so.
void add_to(nlohmann::ordered_json& json, const BackendDescription& description);

}  // namespace pmg::hal
