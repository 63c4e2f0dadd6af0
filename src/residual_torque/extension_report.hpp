// A residual torque for people and machines: a section of the page, a line, a value of diagnosis.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pages/page.hpp"
#include "residual_torque/extension.hpp"

namespace pmg::residual_torque {

/// "residual torque over position_rad: error 12 mrad without it, 5 mrad with it"; or why there is none.
std::string line(const Extension& extension, const std::string& unit_of_thousandths);

nlohmann::ordered_json extension_json(const Extension& extension);

/// The curve, or a curve for each knot of the second quantity.
void show_extension(pages::Page& page, const Extension& extension, const std::string& unit_of_thousandths);

}  // namespace pmg::residual_torque
