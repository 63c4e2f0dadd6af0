// Bars as inline SVG: they show without a script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Bars begin at zero, to the right or to the left. What can't be shown (NaN, infinite) has no bar.
std::string svg(const Bars& bars);

}  // namespace pmg::pages
