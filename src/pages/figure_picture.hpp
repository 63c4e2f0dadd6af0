// Stick figures as inline SVG, still or moving; neither needs a script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

std::string svg(const Figures& figures);

/// Throws std::invalid_argument if a row has no figure, or figures with different numbers of bones.
std::string svg(const MovingFigures& figures);

}  // namespace pmg::pages
