// Lines over any quantity as SVG: they show without a script, and stand in documents too.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Inline in a page. Throws std::invalid_argument when a line's x and y, or y and intervals, aren't equally many.
std::string svg(const Plot& plot);

/// A file of its own: with its title, style and ground.
std::string svg_file(const Plot& plot);

/// The same for several below one another, over the same width.
std::string svg_file(const std::vector<Plot>& plots);

}  // namespace pmg::pages
