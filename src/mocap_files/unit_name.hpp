// Units of length by the names that motion files give them.
#pragma once

#include <optional>
#include <string_view>

namespace pmg::mocap {

/// Metres a unit: m, cm, mm, in, ft and their long names, in any case; nothing for another word.
std::optional<double> unit_of_name(std::string_view name);

}  // namespace pmg::mocap
