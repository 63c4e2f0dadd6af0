// Bars as inline SVG, which needs no script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Bars begin at zero, to the right or to the left. NaN and infinite values have no bar.
std::string svg(const Bars& bars);

}  // namespace pmg::pages
