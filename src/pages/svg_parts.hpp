// What inline SVG pictures have in common.
#pragma once

#include <string>

namespace pmg::pages {

/// A round step for about count ticks over span.
double tick_step(double span, int count);

/// A coloured square and a name; x and y of the text's base line, in the picture's units.
std::string legend_entry(double x, double y, const std::string& colour, const std::string& text);

}  // namespace pmg::pages
