// Bars and histograms as inline SVG: they show without a script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

std::string svg(const Bars& bars);
std::string svg(const Histogram& histogram);

}  // namespace pmg::pages
