// Lines over any quantity as SVG, for pages without a script and for documents.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// For use inside a page. Throws std::invalid_argument if a line's x and y, or y and intervals, differ in number.
std::string svg(const Plot& plot);

/// A complete file, with title, style and background.
std::string svg_file(const Plot& plot);

/// The same for several pictures below each other, of one width.
std::string svg_file(const std::vector<Plot>& plots);

}  // namespace pmg::pages
